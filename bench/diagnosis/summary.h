// The table of trials, kept on disk so that a run goes on where it stopped.
#pragma once

#include <string>
#include <vector>

namespace hapsim::bench {

struct Trial {
  std::string truth, effects;  // name and effects as in Truth, separated by spaces
  double level = 0;            // misfit over noise
  int seed = 0;
  std::string verdict;         // of the model
  std::string missing;         // effects called missing, in order, separated by spaces
  std::string rivals;          // effects called indistinguishable
  std::string left;            // LeftOver::kind of what all that is missing leaves; "": noise
  double now = 0, after = 0;   // error on unseen positions over the floor, before and after adding
  double presses = 0;          // after, on unseen presses of positions that were pressed otherwise
  int own_form = 0;            // 1: what is hidden has a form of the catalogue
  int sized = 0, covered = 0;  // sizes of right effects, and how many 95 % intervals hold the truth
  double seconds = 0;          // of the processor
};

std::vector<Trial> read_trials(const std::string& path);  // none when there is no file
void append_trial(const std::string& path, const Trial& trial);

// To standard output: outcomes by truth, what was named instead, rates, time.
void print_summary(const std::vector<Trial>& trials);

}  // namespace hapsim::bench
