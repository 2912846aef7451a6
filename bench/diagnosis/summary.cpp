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

constexpr double kFloors = 1.3;
const char* const kHeader =
    "truth,effects,level,seed,verdict,missing,rivals,left,now,after,presses,own_form,"
    "sized,covered,"
    "seconds";

std::vector<std::string> words(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> result;
  for (std::string word; in >> word;) result.push_back(word);
  return result;
}

bool holds(const std::vector<std::string>& names, const std::string& name) {
  return std::count(names.begin(), names.end(), name) > 0;
}

// Effects that say that some places are stiffer than others, or some depths.
std::string family(const std::string& effect) {
  return holds({"regions", "layer", "inclusion"}, effect) ? "inhomogeneous" : effect;
}

// Of one hidden effect. `and more`: right first, but others were named as well.
enum Outcome { kExact, kMore, kFamily, kSecond, kAmbiguous, kWrong, kUnnamed, kMissed, kOutcomes };
constexpr const char* kNames[] = {"exact",     "and more", "family",  "second",
                                  "ambiguous", "wrong",    "unnamed", "missed"};

Outcome outcome(const Trial& t) {
  const std::vector<std::string> missing = words(t.missing), rivals = words(t.rivals);
  if (t.effects.empty())
    return missing.empty() && rivals.empty() ? (t.verdict == "complete" ? kExact : kUnnamed)
                                             : kWrong;
  if (!missing.empty()) {
    if (missing.front() == t.effects) return missing.size() + rivals.size() == 1 ? kExact : kMore;
    if (family(missing.front()) == family(t.effects)) return kFamily;
    return missing.size() > 1 && missing[1] == t.effects ? kSecond
           : holds(rivals, t.effects)                    ? kAmbiguous
                                                         : kWrong;
  }
  if (!rivals.empty()) return holds(rivals, t.effects) ? kAmbiguous : kWrong;
  return t.verdict == "complete" ? kMissed : kUnnamed;
}

std::string named(const Trial& t) {
  const std::string sets = t.rivals.empty() ? "" : "{" + t.rivals + "}";
  if (t.missing.empty()) return sets.empty() ? t.verdict : sets;
  std::string text = t.missing;
  std::replace(text.begin(), text.end(), ' ', '+');
  return text + sets;
}

struct Row {
  std::vector<double> levels;
  int count[kOutcomes] = {};
  std::map<std::string, int> instead;
};

void print_rate(const char* what, int n, int of, const char* asked) {
  if (of > 0)
    fmt::print("{:<66} {:>4} of {:>4} = {:5.1f} %  ({})\n", what, n, of, 100.0 * n / of, asked);
}

// Effects found of several that are hidden: in the list of missing ones or in a declared set.
void print_several(const std::vector<Trial>& trials, std::size_t hidden, const char* asked) {
  int all = 0, found = 0, declared = 0, more = 0;
  std::map<std::string, std::vector<std::string>> lines;
  for (const Trial& t : trials) {
    const std::vector<std::string> truth = words(t.effects);
    if (truth.size() != hidden) continue;
    ++all;
    const std::vector<std::string> missing = words(t.missing), rivals = words(t.rivals);
    const auto is_missing = [&](const std::string& e) { return holds(missing, e); };
    const auto known = [&](const std::string& e) { return is_missing(e) || holds(rivals, e); };
    const bool named_all = std::all_of(truth.begin(), truth.end(), is_missing);
    const bool another = std::any_of(missing.begin(), missing.end(),
                                     [&](const std::string& e) { return !holds(truth, e); });
    found += named_all;
    declared += std::all_of(truth.begin(), truth.end(), known);
    more += another;
    lines[t.truth].push_back(named_all && !another && rivals.empty() ? "all" : named(t));
  }
  if (all == 0) return;
  fmt::print("\n{} effects at once\n", hidden);
  for (const auto& [truth, outcomes] : lines)
    fmt::print("{:<46} {}\n", truth, fmt::join(outcomes, "  "));
  print_rate("all named", found, all, asked);
  print_rate("all named or in a declared set", declared, all, "");
  print_rate("another one named besides", more, all, "at most 10 % asked");
}

}  // namespace

std::vector<Trial> read_trials(const std::string& path) {
  std::vector<Trial> trials;
  if (!std::filesystem::exists(path)) return trials;
  Input input(path);
  const CsvTable table = read_csv(input);
  for (std::size_t r = 0; r < table.rows(); ++r) {
    const auto cell = [&](const char* name) { return table.columns[table.find(name)][r]; };
    trials.push_back(
        {cell("truth"), cell("effects"), std::stod(cell("level")), std::stoi(cell("seed")),
         cell("verdict"), cell("missing"), cell("rivals"), cell("left"), std::stod(cell("now")),
         std::stod(cell("after")), std::stod(cell("presses")), std::stoi(cell("own_form")),
         std::stoi(cell("sized")), std::stoi(cell("covered")), std::stod(cell("seconds"))});
  }
  return trials;
}

void append_trial(const std::string& path, const Trial& t) {
  const bool fresh = !std::filesystem::exists(path);
  std::ofstream out(path, std::ios::app);
  if (fresh) out << kHeader << '\n';
  out << fmt::format("{},{},{:.3g},{},{},{},{},{},{:.3f},{:.3f},{:.3f},{},{},{},{:.2f}\n", t.truth,
                     t.effects, t.level, t.seed, t.verdict, t.missing, t.rivals, t.left, t.now,
                     t.after, t.presses, t.own_form, t.sized, t.covered, t.seconds)
      << std::flush;
}

void print_summary(const std::vector<Trial>& trials) {
  std::map<std::string, Row> rows;
  Row hidden;
  int one = 0, nothing = 0, alarms = 0, sized = 0, covered = 0;
  struct Clean {
    int right = 0, places = 0, presses = 0;  // of right ones, errors that come down to the floor
  } clean[2];                                // other forms, own forms
  std::vector<double> seconds;
  for (const Trial& t : trials) {
    seconds.push_back(t.seconds);
    if (words(t.effects).size() > 1) continue;
    Row& row = rows[t.truth];
    row.levels.push_back(t.level);
    const Outcome o = outcome(t);
    ++row.count[o];
    if (o != kExact) ++row.instead[named(t)];
    if (t.effects.empty()) {
      ++nothing;
      alarms += o == kWrong;
      continue;
    }
    ++one;
    ++hidden.count[o];
    sized += t.sized;
    covered += t.covered;
    if (o != kExact && o != kMore && o != kFamily) continue;
    Clean& form = clean[t.own_form];
    ++form.right;
    form.places += t.after <= kFloors;
    form.presses += t.presses <= kFloors;
  }
  fmt::print("{:<32} {:>9}", "truth", "level");
  for (const char* name : kNames) fmt::print(" {:>9}", name);
  fmt::print("  named instead\n");
  for (auto& [truth, row] : rows) {
    std::sort(row.levels.begin(), row.levels.end());
    fmt::print("{:<32} {:>4.2g}-{:<4.2g}", truth, row.levels.front(), row.levels.back());
    for (const int n : row.count) fmt::print(" {:>9}", n > 0 ? std::to_string(n) : ".");
    for (const auto& [name, n] : row.instead) fmt::print("  {} x{}", name, n);
    fmt::print("\n");
  }
  fmt::print("\n");
  const int* n = hidden.count;
  print_rate("right first (regions, layer, inclusion are one family)",
             n[kExact] + n[kMore] + n[kFamily], one, "90 % asked");
  print_rate("... and named alone", n[kExact], one, "");
  print_rate("right among the first two or in a declared set",
             one - n[kWrong] - n[kUnnamed] - n[kMissed], one, "98 % asked");
  print_rate("declared ambiguous, the truth inside", n[kAmbiguous], one, "");
  print_rate("wrong while calling itself clear", n[kWrong] + n[kSecond], one, "at most 3 % asked");
  for (const int own : {1, 0}) {
    const char* const form = own ? "catalogue's forms" : "other forms";
    print_rate(fmt::format("unseen presses within {} x floor, if right, {}", kFloors, form).c_str(),
               clean[own].presses, clean[own].right, "90 % asked");
    print_rate(fmt::format("unseen places within {} x floor, if right, {}", kFloors, form).c_str(),
               clean[own].places, clean[own].right, "90 % asked");
  }
  print_rate("sizes inside their 95 % intervals", covered, sized, "85 % asked");
  print_rate("false alarms where nothing is hidden", alarms, nothing, "at most 2 % asked");
  print_several(trials, 2, "all asked");
  print_several(trials, 3, "70 % asked");
  if (seconds.empty()) return;
  std::sort(seconds.begin(), seconds.end());
  fmt::print("\ntime of a diagnosis, of the processor: median {:.2f} s, longest {:.2f} s\n",
             seconds[seconds.size() / 2], seconds.back());
}

}  // namespace hapsim::bench
