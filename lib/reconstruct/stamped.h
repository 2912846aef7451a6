// Vertices, faces and cells of CGAL's triangulations in the order in which they were made. Without
// a time stamp CGAL orders handles by their addresses, and what it does in that order (smoothing,
// choosing the cell that stands for an edge) depends on where the memory lies.
#pragma once

#include <CGAL/tags.h>

#include <cstddef>

namespace hapsim {

// The vertex, face or cell base `Base` of a triangulation data structure, with a time stamp. A
// stamp that a base of CGAL 5.5 has itself is not initialised when the place of a removed one is
// used again.
template <class Base>
class Stamped : public Base {
 public:
  using Base::Base;
  template <class Structure>
  struct Rebind_TDS {
    using Other = Stamped<typename Base::template Rebind_TDS<Structure>::Other>;
  };

  using Has_timestamp = CGAL::Tag_true;
  std::size_t time_stamp() const { return stamp_; }
  void set_time_stamp(std::size_t stamp) { stamp_ = stamp; }

 private:
  std::size_t stamp_ = static_cast<std::size_t>(-1);  // CGAL: none yet
};

}  // namespace hapsim
