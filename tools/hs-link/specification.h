// What hs-link takes and gives, for --help and the man page.
#pragma once

#include "common_options.h"
#include "hs-link/flags.h"
#include "prepared_options.h"
#include "safety/safety_options.h"
#include "stream_options.h"

namespace hapsim {

inline ToolSpec link_specification() {
  ToolSpec spec;
  spec.name = "hs-link";
  spec.task = Task::kForces;
  spec.summary = "telepresence: an operator and a teleoperator over UDP";
  spec.input = "operator: motion (press,t,x,y,z,ux,uy,uz[,contact]), a line a sample";
  spec.description = {
      "Two processes. The teleoperator (--listen) presses a body, --body with --model, by the "
      "motions that come and answers each with the force, with all effects of the model but those "
      "of a force sensor: a hand feels the body itself. A tool that goes further than nine tenths "
      "of the way through the body is held there. The operator (--peer) sends its motion "
      "at "
      "--rate by the clock and feels the newest force that has come back, late by what the network "
      "takes.",
      "From the answers the operator identifies the modulus of its own --body, and moduli of "
      "relaxation at the times of --times, while it runs: unit forces are computed beforehand, so "
      "that costs microseconds. Once --samples answers are there the identified body is felt, at "
      "once, without a jump; later answers go on improving it.",
      "A network as bad as wished is put before the real one on the sending side of each process: "
      "--delay, --jitter, --loss, --duplicate, --reorder.",
      "The link is closed. Both sides prove that they have the --key before anything that they "
      "say counts (X25519, HMAC-SHA-512-256, BLAKE2b), and agree on version, units, tool and "
      "body; every packet is sealed (ChaCha20-Poly1305) and is taken once. Nothing else is "
      "answered. A side that dies and comes back, or changes its address, is served again once "
      "it has proved itself; another operator only when the first has been silent for half a "
      "second. Without a key only this machine is spoken to, unless --insecure is given.",
      "What the hand feels has limits of force, rate, power, energy and workspace, and goes to "
      "zero "
      "within "
      "--hold and --ramp when the teleoperator or the motion is silent; column safety says so in "
      "every line, and ax, ay, az are what was asked for. So have the teleoperator's motions, "
      "which take the tool back when the operator is lost. See hs-safety(7). Exit code 5 when the "
      "teleoperator is gone at the end, 3 when it refuses.",
      "A late force is active: it gives the hand energy that the hand has not put in. That is "
      "counted "
      "at both sides, and what is felt is damped and cut so that it never exceeds --max-energy "
      "(passivity in time; column energy, bit 256 of safety). A hand that is owed nothing feels "
      "what "
      "was asked for, bit for bit: so once the body is identified.",
      "Every line of the operator goes out at once: on standard output nothing but the last one "
      "can be "
      "lost, however it ends. SIGINT or SIGTERM ends either side in its order: what was felt and "
      "identified is written."};
  spec.options = {
      {.flag = flag::listen,
       .value = "HOST:PORT",
       .help = "Teleoperator: where motions come to. Port 0 takes a free one and says which.",
       .group = "Teleoperator"},
      {.flag = flag::peer,
       .value = "HOST:PORT",
       .help = "Operator: where the teleoperator listens.",
       .group = "Operator"},
      {.flag = flag::body,
       .value = "FILE",
       .help = "Body: the one that is pressed, or the one that is identified.",
       .group = "Both sides"},
      {.flag = flag::key,
       .value = "FILE",
       .help = "The key of the link, the same on both sides: whoever has it, and nobody else, is "
               "spoken to.",
       .group = "Both sides"},
      {.flag = flag::make_key,
       .value = "FILE",
       .help = "Makes a new key, and does nothing else. A file that is there is never overwritten.",
       .group = "Both sides"},
      {.flag = flag::insecure,
       .help = "Without a key also over a network that others use: they can press, and be felt.",
       .group = "Both sides"},
      {.flag = flag::expect_model,
       .value = "FILE",
       .help = "Operator: refuses a teleoperator whose body has another model than this.",
       .group = "Operator"},
      {.flag = flag::patience,
       .value = "S",
       .help = "Operator: how long the teleoperator is waited for at the start [s].",
       .group = "Operator",
       .default_text = "5",
       .minimum = 0.1,
       .maximum = 1e6},
      {.flag = flag::model,
       .value = "FILE",
       .help = "Teleoperator: the body's model.",
       .group = "Teleoperator"},
      {.flag = flag::tool_radius,
       .value = "M",
       .help = "Radius of the flat tool [m]; the operator's otherwise from its motion.",
       .group = "Both sides",
       .minimum = 1e-6,
       .maximum = 1},
      {.flag = flag::samples,
       .value = "N",
       .help = "Operator: answers in contact before the identified body is felt; 0: never.",
       .group = "Operator",
       .default_text = "500",
       .minimum = 0,
       .maximum = 1e9},
      {.flag = flag::rate,
       .value = "HZ",
       .help = "Operator: motion lines a second; 0: each as soon as it comes, of a live hand.",
       .group = "Operator",
       .default_text = "1000",
       .minimum = 0,
       .maximum = 20000},
      {.flag = flag::identified,
       .value = "FILE",
       .help = "Operator: writes the identified model.",
       .group = "Operator",
       .writes = kTableExtensions},
      {.flag = flag::delay,
       .value = "S",
       .help = "Least time of a packet on its way there [s].",
       .group = "Network",
       .default_text = "0",
       .minimum = 0,
       .maximum = 3},
      {.flag = flag::jitter,
       .value = "S",
       .help = "Size of what comes on top of it, changing within a tenth of a second [s].",
       .group = "Network",
       .default_text = "0",
       .minimum = 0,
       .maximum = 1},
      {.flag = flag::loss,
       .value = "SHARE",
       .help = "Share of packets that are lost.",
       .group = "Network",
       .default_text = "0",
       .minimum = 0,
       .maximum = 1},
      {.flag = flag::duplicate,
       .value = "SHARE",
       .help = "Share of packets that come twice.",
       .group = "Network",
       .default_text = "0",
       .minimum = 0,
       .maximum = 1},
      {.flag = flag::reorder,
       .value = "SHARE",
       .help = "Share of packets with a jitter of their own, that overtake or are overtaken.",
       .group = "Network",
       .default_text = "0",
       .minimum = 0,
       .maximum = 1},
      {.flag = flag::add_noise,
       .value = "N",
       .help = "Teleoperator: adds Gaussian noise of this standard deviation [N] to every force "
               "component.",
       .group = "Teleoperator",
       .default_text = "0",
       .minimum = 0},
      {.flag = flag::seed,
       .value = "N",
       .help = "Seed of the network's chance and of the noise.",
       .group = "Network",
       .default_text = "1",
       .minimum = 0},
      {.flag = flag::idle,
       .value = "S",
       .help = "Teleoperator: ends when nothing has come for so long; 0: only by a signal.",
       .group = "Teleoperator",
       .default_text = "5",
       .minimum = 0,
       .maximum = 1e6}};
  spec.options.push_back(accuracy_option("Body"));
  for (const Option& option : online_flags("Operator")) spec.options.push_back(option);
  for (const Option& option : safety_flags()) spec.options.push_back(option);
  spec.tables = {
      {"Output of the operator",
       {{"press, t, x, y, z, ux, uy, uz", "the motion"},
        {"fx, fy, fz", "what is felt [N]"},
        {"contact", "1 in contact, 0 in the air"},
        {"mx, my, mz", "the newest force that has come [N]"},
        {"predicted", "1 where the identified body is felt"},
        {"safety",
         "0, or a sum of: 1 force cut, 2 its change cut, 4 its power cut, 8 outside the "
         "workspace, 16 no valid sample, 32 held, 64 on the way to zero and there, 128 "
         "ended, 256 damped or cut for its energy"},
        {"ax, ay, az", "the force that was asked for [N]"},
        {"energy", "that the hand has put in so far [J]; below zero: that it has got"},
        {"mt",
         "time of the row that mx, my, mz answer [s]; empty: nothing has come of this press"}}}};
  spec.examples = {
      {"hs-link --listen 9000 --body real.ply --model hidden.csv --tool-radius 0.004 --delay 0.15",
       "The far side, with half of the delay."},
      {"hs-link motion.csv --peer 9000 --body body.ply --delay 0.15 --jitter 0.05 --loss 0.05 -o "
       "felt.csv",
       "The near side."},
      {"hs-link --make-key lab.key", "A key for both, to be copied by a safe way."}};
  spec.see_also = {"hs-simulate(1)", "hs-identify(1)", "hs-safety(7)"};
  return spec;
}

}  // namespace hapsim
