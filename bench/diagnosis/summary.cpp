#include "summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "io/csv.h"

namespace hapsim::bench {
namespace {

const char* const kHeader = "truth,effect,level,seed,verdict,missing,rivals,seconds";

std::vector<std::string> words(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> result;
  for (std::string word; in >> word;) result.push_back(word);
  return result;
}

enum Outcome { kExact, kFirst, kAmbiguous, kWrong, kUnnamed, kMissed, kOutcomes };
constexpr const char* kNames[] = {"exact", "first", "ambiguous", "wrong", "unnamed", "missed"};

Outcome outcome(const Trial& t) {
  const std::vector<std::string> missing = words(t.missing), rivals = words(t.rivals);
  if (t.effect.empty())
    return missing.empty() && rivals.empty() ? (t.verdict == "complete" ? kExact : kUnnamed)
                                             : kWrong;
  if (!missing.empty())
    return missing.front() != t.effect             ? kWrong
           : missing.size() == 1 && rivals.empty() ? kExact
                                                   : kFirst;
  if (!rivals.empty())
    return std::count(rivals.begin(), rivals.end(), t.effect) > 0 ? kAmbiguous : kWrong;
  return t.verdict == "complete" ? kMissed : kUnnamed;
}

std::string named(const Trial& t) {
  if (!t.missing.empty()) return words(t.missing).front();
  if (!t.rivals.empty()) return "{" + t.rivals + "}";
  return t.verdict;
}

}  // namespace

std::vector<Trial> read_trials(const std::string& path) {
  std::vector<Trial> trials;
  if (!std::filesystem::exists(path)) return trials;
  Input input(path);
  const CsvTable table = read_csv(input);
  for (std::size_t r = 0; r < table.rows(); ++r) {
    const auto cell = [&](const char* name) { return table.columns[table.find(name)][r]; };
    trials.push_back({cell("truth"), cell("effect"), std::stod(cell("level")),
                      std::stoi(cell("seed")), cell("verdict"), cell("missing"), cell("rivals"),
                      std::stod(cell("seconds"))});
  }
  return trials;
}

void append_trial(const std::string& path, const Trial& t) {
  const bool fresh = !std::filesystem::exists(path);
  std::ofstream out(path, std::ios::app);
  if (fresh) out << kHeader << '\n';
  out << fmt::format("{},{},{:g},{},{},{},{},{:.2f}\n", t.truth, t.effect, t.level, t.seed,
                     t.verdict, t.missing, t.rivals, t.seconds)
      << std::flush;
}

void print_summary(const std::vector<Trial>& trials) {
  struct Row {
    int count[kOutcomes] = {};
    std::map<std::string, int> instead;
  };
  std::map<std::pair<std::string, double>, Row> rows;
  Row hidden;
  int nothing = 0, alarms = 0;
  std::vector<double> seconds;
  for (const Trial& t : trials) {
    Row& row = rows[{t.truth, t.level}];
    const Outcome o = outcome(t);
    ++row.count[o];
    if (o != kExact) ++row.instead[named(t) + (o == kFirst ? " and more" : "")];
    if (t.effect.empty()) {
      ++nothing;
      alarms += o == kWrong;
    } else {
      ++hidden.count[o];
    }
    seconds.push_back(t.seconds);
  }
  fmt::print("{:<32} {:>5}", "truth", "level");
  for (const char* name : kNames) fmt::print(" {:>9}", name);
  fmt::print("  otherwise named\n");
  for (const auto& [key, row] : rows) {
    fmt::print("{:<32} {:>5g}", key.first, key.second);
    for (const int n : row.count) fmt::print(" {:>9}", n > 0 ? std::to_string(n) : ".");
    for (const auto& [name, n] : row.instead) fmt::print("  {} x{}", name, n);
    fmt::print("\n");
  }
  int total = 0;
  for (const int n : hidden.count) total += n;
  if (total > 0) {
    fmt::print("{} trials with something hidden:", total);
    for (int o = 0; o < kOutcomes; ++o)
      fmt::print(" {} {:.1f} %{}", kNames[o], 100.0 * hidden.count[o] / total,
                 o + 1 < kOutcomes ? "," : "\n");
  }
  if (nothing > 0)
    fmt::print("false alarms: {} of {} trials with nothing hidden\n", alarms, nothing);
  if (seconds.empty()) return;
  std::sort(seconds.begin(), seconds.end());
  fmt::print("time of a diagnosis: median {:.2f} s, longest {:.2f} s\n",
             seconds[seconds.size() / 2], seconds.back());
}

}  // namespace hapsim::bench
