// Long recordings as fewer rows: means of neighbours, in one pass and bounded memory.
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "recording/recording.h"

namespace hapsim {

// What has been averaged, and what that costs.
struct Thinning {
  std::size_t recorded = 0;  // rows
  std::size_t kept = 0;      // rows that are left
  int block = 1;             // rows that nearly all of them are the mean of
  double span = 0;           // between the first and the last time of such a mean, median [s]
  // Of the information (Fisher's, its trace) that the rows have on whatever acts in proportion to
  // the displacement, and to its rate: the share that the means keep. A motion that was measured
  // with noise loses that of its rate. NaN: there is none.
  double displacement = std::numeric_limits<double>::quiet_NaN();
  double rate = std::numeric_limits<double>::quiet_NaN();
  double noise_before = 0, noise_after = 0;  // declared, and of a mean [N]; 0: none was declared

  bool thinned() const { return kept < recorded; }
};
// In one sentence; "" where all rows are there.
std::string thinning_words(const Thinning& thinning);

// Rows of one press that follow one another at one place, all in contact or all in the air, become
// means of 2, 4, 8 ... of them as soon as there are more than `most` rows in all: as many of each
// press's rows a mean, so that all means are worth the same; not where fewer than 20 means would be
// left of a run of such rows, on average. Forces in proportion to displacements are unchanged by
// that; what happens within a mean is lost. The mean has the first row's line, place and unknown
// columns, and the times' mean.
//
// The noise of a mean is that of a row over the root of their number only where neighbours do not
// err alike. How far they do is measured at every number on the way, from fourth differences of
// forces in each press, of which smooth motion is no part: of a declared variance s^2
//   s^2 - max_k v_k + v
// is left, v_k the variance seen between means of k rows and v that between the last ones. So noise
// that wanders more slowly than the means, or that no difference shows, is not thought to be
// averaged away.
class Thinner {
 public:
  // `noise`: of the rows [N], 0: as the recording declares it.
  explicit Thinner(std::size_t most, double noise = 0) : most_(most), declared_(noise) {}

  // After each row that was put at the recording's end.
  void added(Recording& recording);
  // After the last row and the metadata; declares the means' noise where there was one.
  Thinning end(Recording& recording);

 private:
  struct Run {
    std::size_t begin = 0, end = 0;
  };
  bool go_together(const Recording& r, std::size_t a, std::size_t b) const;
  std::vector<Run> runs(const Recording& r) const;
  void count_information(const Recording& r, std::size_t row);
  void look_at_noise(const Recording& r);
  void halve(Recording& r);
  void end_runs(Recording& r);
  void merge(Recording& r, const std::vector<std::size_t>& to);

  std::size_t most_;
  double declared_;
  int block_ = 1;
  std::vector<int> count_;            // of each row, of how many it is the mean
  std::vector<double> first_, last_;  // times of each [s]; empty without
  std::size_t recorded_ = 0;
  double displacement_ = 0, rate_ = 0;  // sums over the recorded rows
  Vec3 last_u_ = Vec3::Zero();
  double last_t_ = 0;
  int last_press_ = 0;
  double seen_ = 0, now_ = 0;  // max_k v_k, v [N^2]
};

// As read_recording(), at most so many rows, or 40 of each run where that is more; 0: all of them.
Recording read_thinned(Input& input, bool need_forces, std::size_t most, double noise,
                       Thinning& thinning);

}  // namespace hapsim
