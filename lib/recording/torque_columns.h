// The torques of a recording: carried through as columns, and read where somebody asks for them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "recording/force_noise.h"
#include "recording/recording.h"

namespace hapsim {

// The columns tqx,tqy,tqz: torque of the body on the tool about its tip, the middle of its flat
// face, which moves with it [N m], in the frame of the forces; as the live mode writes it.
inline constexpr const char* kTorqueColumns[] = {"tqx", "tqy", "tqz"};

struct Torques {
  std::vector<Vec3> values;  // by row [N m]; empty: there are none about the tip
  std::string unused;        // why torques that are there are not; "": none are, or they are used
};

// tqx,tqy,tqz; else tx,ty,tz, which are about the sensor's origin, taken to the tip by the measured
// force where the metadata `torque_at` says where that origin lies (x y z from the tip [m], in the
// frame of the forces): tq = t + at x f. Error(kBadInput): a cell that is no number, or one or two
// of the columns; torques that no body answers with, more than kMostLever radii of the tool times
// the forces beyond their declared noise (newton millimetres, another point).
Torques read_torques(const Recording& recording);
inline constexpr double kMostLever = 5;

// Whether it has columns tqx,tqy,tqz; whether read_torques() finds torques in it.
bool has_tip_torques(const Recording& recording);
bool has_torques(const Recording& recording);

// Whether one of its columns thx,thy,thz is not zero.
bool tool_turns(const Recording& recording);
// Says why the recording's torques, which are taken away, are not used: Torques::unused.
void forget_torques_because(Recording& recording, const std::string& why);

// Writes them as tqx,tqy,tqz, in the place of those that were there; none: takes those away.
void set_torques(Recording& recording, const std::vector<Vec3>& torques);
// Takes away all that read_torques() reads, and what is declared of it.
void forget_torques(Recording& recording);

// The metadata `torque_noise` [N m], a standard deviation per component, else measured as that of
// forces is (recording/force_noise.h). Error(kBadInput) where it is no such number.
Noise torque_noise(const Recording& recording, const std::vector<Vec3>& torques);
void forget_torque_noise(Metadata& metadata);

}  // namespace hapsim
