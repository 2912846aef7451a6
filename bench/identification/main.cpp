// Trials of the identification: what is found against what is true, over many draws of the noise.
// The forces come from meshes with two thirds of every length of the model's, made from a finer
// surface,
// and relax by closed forms.
//   bench_identification OUT [WORDS...]: the cases whose names begin with one of the words
// Results in OUT/results.csv are gone on with; delete the file to begin anew. DRAWS=N: fewer draws.
// Recorded in bench/results/identification*.txt (bench/record.sh).
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <mutex>
#include <set>
#include <thread>

#include "base/blas.h"
#include "base/error.h"
#include "cases.h"

namespace hapsim::bench {
namespace {

void run(const Case& c, const std::string& out, int draws, std::vector<Result>& results) {
  const std::string path = out + "/results.csv";
  std::set<int> known;
  for (const Result& r : results)
    if (r.trial == c.name) known.insert(r.draw);
  std::vector<int> left;
  for (int draw = 1; draw <= draws; ++draw)
    if (known.count(draw) == 0) left.push_back(draw);
  if (left.empty()) return;
  const Draw draw = c.prepare(out);
  std::mutex mutex;
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t k = next++; k < left.size(); k = next++) {
      const std::vector<Result> found = draw(left[k]);
      const std::lock_guard lock(mutex);
      append_results(path, found);
      results.insert(results.end(), found.begin(), found.end());
    }
  };
  std::vector<std::thread> pool;
  for (unsigned i = 1; i < std::max(1u, std::thread::hardware_concurrency()); ++i)
    pool.emplace_back(work);
  work();
  for (std::thread& thread : pool) thread.join();
}

int run_all(const std::string& out, const std::vector<std::string>& words) {
  std::filesystem::create_directories(out);
  prepare_blas_for_many_threads();
  std::vector<Case> cases = elastic_cases();
  for (const auto& more : {viscoelastic_cases(), region_cases(), imaging_cases()})
    cases.insert(cases.end(), more.begin(), more.end());
  const char* limit = std::getenv("DRAWS");
  std::vector<Result> results = read_results(out + "/results.csv");
  for (const Case& c : cases) {
    const bool asked = words.empty() || std::any_of(words.begin(), words.end(), [&](auto& word) {
                         return c.name.rfind(word, 0) == 0;
                       });
    if (asked)
      run(c, out, limit != nullptr ? std::min(c.draws, std::atoi(limit)) : c.draws, results);
  }
  print_results(results);
  return 0;
}

}  // namespace
}  // namespace hapsim::bench

int main(int argc, char** argv) {
  if (argc < 2) {
    fmt::print(stderr, "bench_identification OUT [WORDS...]\n");
    return 2;
  }
  try {
    return hapsim::bench::run_all(argv[1], {argv + 2, argv + argc});
  } catch (const hapsim::Error& error) {
    fmt::print(stderr, "bench_identification: {}\n", error.what());
    return 3;
  }
}
