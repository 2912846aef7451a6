#include "table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "io/csv.h"

namespace hapsim::bench {

std::vector<Result> read_results(const std::string& path) {
  std::vector<Result> results;
  if (!std::filesystem::exists(path)) return results;
  Input input(path);
  const CsvTable table = read_csv(input);
  for (std::size_t r = 0; r < table.rows(); ++r) {
    const auto cell = [&](const char* name) { return table.columns[table.find(name)][r]; };
    results.push_back({cell("trial"), std::stoi(cell("draw")), cell("name"),
                       std::stod(cell("truth")), std::stod(cell("value")),
                       std::stod(cell("std_error")), std::stod(cell("limit"))});
  }
  return results;
}

void append_results(const std::string& path, const std::vector<Result>& results) {
  const bool fresh = !std::filesystem::exists(path);
  std::ofstream out(path, std::ios::app);
  if (fresh) out << "trial,draw,name,truth,value,std_error,limit\n";
  for (const Result& r : results)
    out << fmt::format("{},{},{},{:.9g},{:.9g},{:.9g},{:g}\n", r.trial, r.draw, r.name, r.truth,
                       r.value, r.std_error, r.limit);
  out << std::flush;
}

void print_results(const std::vector<Result>& results) {
  std::vector<std::pair<std::string, std::string>> keys;
  for (const Result& r : results)
    if (std::find(keys.begin(), keys.end(), std::pair(r.trial, r.name)) == keys.end())
      keys.emplace_back(r.trial, r.name);
  fmt::print("{:<28} {:<10} {:>5} {:>10} {:>10} {:>9} {:>9} {:>10} {:>9} {:>11}\n", "trial", "what",
             "draws", "truth", "mean", "rms err", "worst", "asked", "as asked", "in 95 %");
  for (const auto& [trial, name] : keys) {
    int draws = 0, good = 0, stated = 0, covered = 0;
    double mean = 0, squares = 0, worst = 0, truth = 0, limit = 0;
    for (const Result& r : results) {
      if (r.trial != trial || r.name != name) continue;
      ++draws;
      limit = r.limit;
      truth = r.truth;
      const double scale = limit < 0 ? r.truth : 1;
      const double error = std::abs(r.value - r.truth) / scale;
      mean += r.value;
      squares += error * error;
      worst = std::max(worst, error);
      good += error <= std::abs(limit);
      if (std::isnan(r.std_error)) continue;
      ++stated;
      covered += std::abs(r.value - r.truth) <= 1.96 * r.std_error;
    }
    const auto sized = [&](double v) {
      return limit < 0 ? fmt::format("{:.2f} %", 100 * v) : fmt::format("{:.4g}", v);
    };
    fmt::print("{:<28} {:<10} {:>5} {:>10.4g} {:>10.4g} {:>9} {:>9} {:>10} {:>9} {:>11}\n", trial,
               name, draws, truth, mean / draws, sized(std::sqrt(squares / draws)), sized(worst),
               limit == 0 ? "." : sized(std::abs(limit)),
               limit == 0 ? "." : fmt::format("{}/{}", good, draws),
               stated == 0 ? "." : fmt::format("{:.1f} %", 100.0 * covered / stated));
  }
}

}  // namespace hapsim::bench
