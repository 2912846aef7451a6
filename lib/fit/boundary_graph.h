// Boundaries between regions that move a little: lines in plan view, each key point shifted along
// its normal.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "cluster/class_boundary.h"

namespace hapsim {

class BoundaryGraph {
 public:
  // `keys` points evenly along each line; `classify` tells which region lies on which side. Ends of
  // lines go on straight, unless another line ends there (within `join`) as well.
  BoundaryGraph(const std::vector<BoundaryLine>& lines, const PlaneClassifier& classify, int keys,
                double join);

  std::size_t size() const { return point_.size(); }  // shifts: key points of all lines
  const std::vector<Eigen::Vector2d>& points() const { return point_; }  // where nothing is shifted

  // What lies at a place: `share` of `left`, the rest `right`, going from 0 to 1 over `width` about
  // the nearest boundary; and its derivative by the shifts of the two key points between which it
  // lies.
  struct Blend {
    int left = 0, right = 0;
    double share = 0;
    std::size_t key[2] = {0, 0};
    double by_shift[2] = {0, 0};  // [1/m]
  };
  Blend at(const Eigen::Vector2d& p, const Eigen::VectorXd& shift, double width) const;
  int region(const Eigen::Vector2d& p, const Eigen::VectorXd& shift) const;
  std::vector<BoundaryLine> lines(const Eigen::VectorXd& shift) const;

 private:
  struct Line {
    int left = 0, right = 0;
    std::size_t first = 0, count = 0;  // of the key points; a closed line has the first but once
    bool closed = false;
    bool goes_on[2] = {true, true};
  };
  struct Foot;  // the nearest place of a line
  Foot foot_on(const Line& line, const Eigen::Vector2d& p) const;

  std::vector<Line> line_;
  std::vector<Eigen::Vector2d> point_, normal_;  // normals to the left
};

}  // namespace hapsim
