// A haptic device driven by hapsim, through CHAI3D 3.2 (https://www.chai3d.org): its first device
// presses the body. usage: device_chai3d X Y Z SCALE hs-simulate-arguments...
//   X Y Z [m]: where in the body's frame the middle of the device's workspace is; SCALE: how much
//   larger motions are there. Written against CHAI3D's documentation; not tried on hardware. Forces
//   go through hs-simulate's --hand with the device's own largest; one that is late is felt for 10
//   ms on, and fades out within 50: the device is never left with an old one, and its loop never
//   waits longer than 2 ms. Zero is set before anything else at every end, a signal's too.
#include <chai3d.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "hapsim_stream.h"

namespace {
std::atomic<bool> stopped{false};
}

int main(int argc, char** argv) {
  if (argc < 6) {
    std::fprintf(stderr,
                 "usage: %s X Y Z SCALE --body body.ply --model m.csv --tool-radius 0.004\n",
                 argv[0]);
    return 2;
  }
  const double scale = std::atof(argv[4]);
  const double middle[3] = {std::atof(argv[1]), std::atof(argv[2]), std::atof(argv[3])};
  chai3d::cHapticDeviceHandler handler;
  chai3d::cGenericHapticDevicePtr device;
  if (!handler.getDevice(device, 0) || !device->open()) {
    std::fprintf(stderr, "no haptic device\n");
    return 5;
  }
  device->calibrate();
  const double strongest = device->getSpecifications().m_maxLinearForce;
  const double stiffest = device->getSpecifications().m_maxAngularTorque;
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT})
    std::signal(signal, [](int) { stopped = true; });
  const auto let_go = [&] {
    device->setForceAndTorque(chai3d::cVector3d(0, 0, 0), chai3d::cVector3d(0, 0, 0));
  };
  int code = 0;
  try {
    std::vector<std::string> words(argv + 5, argv + argc);
    words.insert(words.end(), {"--hand", "--max-force", std::to_string(strongest)});
    HapsimStream hapsim(words);
    LateForce late(0.01, 0.05);
    const auto start = std::chrono::steady_clock::now();
    // Before the stream, whose end may take a second.
    struct LetGo {
      const decltype(let_go)& now;
      ~LetGo() { now(); }
    } at_the_end{let_go};
    while (!stopped && !hapsim.ended()) {  // CHAI3D's devices pace the loop
      chai3d::cVector3d p, axis;
      chai3d::cMatrix3d orientation;
      device->getPosition(p);
      device->getRotation(orientation);
      double angle = 0;
      orientation.toAxisAngle(axis, angle);
      const double t =
          std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      HapsimPose pose;
      pose.tip = {middle[0] + scale * p.x(), middle[1] + scale * p.y(), middle[2] + scale * p.z()};
      pose.turn = {angle * axis.x(), angle * axis.y(), angle * axis.z()};
      const double factor = late.factor(t, hapsim.exchange(t, {pose}, 0.002));
      const HapsimFeel& feel = hapsim.feel()[0];
      chai3d::cVector3d force(feel.force[0], feel.force[1], feel.force[2]);
      chai3d::cVector3d torque(feel.torque[0], feel.torque[1], feel.torque[2]);
      force.mul(factor);
      torque.mul(factor / scale);  // the same work: turns are not scaled
      if (force.length() > strongest) force.mul(strongest / force.length());
      if (torque.length() > stiffest) torque.mul(stiffest / torque.length());
      device->setForceAndTorque(force, torque);
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    code = 4;
  }
  let_go();
  device->close();
  return code;
}
