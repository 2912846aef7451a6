#include "c/handles.h"
#include "c/options.h"
#include "cli/shared_flags.h"
#include "experiment/plausible.h"
#include "experiment/preparation_flags.h"
#include "simulate/simulate.h"

using namespace hapsim;

hs_status hs_simulate(const hs_body* body, const hs_model* model, const hs_recording* motion,
                      const hs_options* options, hs_recording** forces) {
  constexpr ForceFlag kAddNoise{"--add-noise"};
  constexpr IntegerFlag kSeed{"--seed"};
  return made(forces, [&] {
    std::vector<Option> known = preparation_flags();
    known.push_back({.flag = kAddNoise, .value = "N", .minimum = 0});
    known.push_back({.flag = kSeed, .value = "N", .default_text = "1", .minimum = 0});
    const Asked asked("hs-simulate", std::move(known), options);
    const Arguments& arguments = asked.arguments();
    const auto say = asked.say();
    for (const std::string& words : doubts_of(model->model)) say(words);
    for (const std::string& words : doubts_of(model->model, std::span(&body->mesh, 1))) say(words);
    Recording result =
        simulate(body->mesh, model->model, as_asked(arguments, motion->recording, false, say),
                 preparation_options(arguments), say)
            .recording;
    if (arguments.given(kAddNoise))
      add_noise(result, arguments[kAddNoise], static_cast<std::uint64_t>(arguments[kSeed]));
    return handle_of(std::move(result));
  });
}
