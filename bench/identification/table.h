// Results of the trials, kept on disk so that a run goes on where it stopped.
#pragma once

#include <string>
#include <vector>

namespace hapsim::bench {

// One number that a trial gave. `std_error` NaN: none was stated.
struct Result {
  std::string trial;  // "elastic block"
  int draw = 0;
  std::string name;  // "E"
  double truth = 0, value = 0, std_error = 0;
  double limit = 0;  // what is asked of |value - truth|: relative when negative; 0: nothing
};

std::vector<Result> read_results(const std::string& path);  // none when there is no file
void append_results(const std::string& path, const std::vector<Result>& results);

// To standard output: by trial and name how many draws, the mean, the error (root mean square and
// worst), how many are as asked, how many stated 95 % intervals hold the truth.
void print_results(const std::vector<Result>& results);

}  // namespace hapsim::bench
