#include "imaging/lump_file.h"

#include <fmt/format.h>

namespace hapsim {

void write_lumps(std::ostream& out, const StiffnessImage& image) {
  for (const Sight& s : image.found.sight)
    out << fmt::format("# sight: {:.6g} {:.6g} {:.6g}\n", s.radius, s.ratio, s.depth);
  out << fmt::format("# false_alarm: {:.6g}\n", kFalseAlarm);
  out << "lump";
  for (const char* name : {"x", "y", "z", "depth", "radius", "ratio"})
    out << fmt::format(",{0},{0}_low,{0}_high", name);
  out << ",chance\n";
  int number = 0;
  for (const Lump& l : image.lumps) {
    out << ++number;
    const auto write = [&](double value, const Interval& in) {
      out << fmt::format(",{:.6g},{:.6g},{:.6g}", value, in.low, in.high);
    };
    write(l.centre.x(), l.x);
    write(l.centre.y(), l.y);
    write(l.centre.z(), l.z);
    write(l.depth, l.depth_in);
    write(l.radius, l.radius_in);
    write(l.ratio, l.ratio_in);
    out << fmt::format(",{:.3g}\n", l.chance);
  }
}

}  // namespace hapsim
