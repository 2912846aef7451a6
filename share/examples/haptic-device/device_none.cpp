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
    std::vector<std::string> words(argv + 4, argv + argc);
    words.push_back("--hand");  // whatever it is given, what comes back is within limits
    HapsimStream hapsim(words);
    double largest = 0, twist = 0;
    long late = 0, limited = 0;
    for (int i = 0; i < 2000; ++i) {
      const double t = 1e-3 * i;
      HapsimPose pose;
      pose.tip = {x + 1e-3 * std::sin(5 * t), y + 1e-3 * std::cos(5 * t),
                  z + 1e-3 - 3e-3 * std::pow(std::sin(3 * t), 2)};
      pose.turn = {0, 0, 0.1 * std::sin(2 * t)};
      // Without a clock nothing is in a hurry; a driver takes about the period of its loop.
      if (!hapsim.exchange(t, {pose}, 10)) ++late;
      const HapsimFeel& feel = hapsim.feel()[0];
      if (feel.safety != 0) ++limited;
      largest = std::fmax(largest, feel.force[2]);
      twist = std::fmax(twist, std::fabs(feel.torque[2]));
    }
    std::printf("largest force along z %.4g N, torque about z %.4g N m, %ld late, %ld limited\n",
                largest, twist, late, limited);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 4;
  }
  return 0;
}
