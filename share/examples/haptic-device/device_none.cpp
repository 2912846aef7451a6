// A device that is not there: its tip circles over the body and dips into it, 1 kHz without a
// clock. Shows what a driver does. usage: device_none X Y Z hs-simulate-arguments...
//   X Y Z [m]: a point of the surface seen from above.
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "hapsim_stream.h"

int main(int argc, char** argv) {
  if (argc < 5) {
    std::fprintf(stderr, "usage: %s X Y Z --body body.ply --model m.csv --tool-radius 0.004\n",
                 argv[0]);
    return 2;
  }
  const double x = std::atof(argv[1]), y = std::atof(argv[2]), z = std::atof(argv[3]);
  try {
    HapsimStream hapsim(std::vector<std::string>(argv + 4, argv + argc));
    double largest = 0;
    for (int i = 0; i < 2000; ++i) {
      const double t = 1e-3 * i;
      const auto f = hapsim.force(t, {x + 1e-3 * std::sin(5 * t), y + 1e-3 * std::cos(5 * t),
                                      z + 1e-3 - 3e-3 * std::pow(std::sin(3 * t), 2)});
      largest = std::fmax(largest, f[2]);
    }
    std::printf("largest force along z %.4g N\n", largest);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 4;
  }
  return 0;
}
