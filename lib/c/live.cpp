#include <memory>
#include <optional>
#include <utility>

#include "c/handles.h"
#include "c/options.h"
#include "cli/shared_flags.h"
#include "experiment/contact_radius.h"
#include "experiment/fitted_range.h"
#include "experiment/plausible.h"
#include "experiment/preparation_flags.h"
#include "realtime/accuracy_option.h"
#include "realtime/force_loop.h"
#include "safety/safe_force.h"
#include "safety/safety_options.h"

struct hs_prepared {
  hapsim::FittedRange fitted;
  std::shared_ptr<const hapsim::PreparedBody> body;
};

struct hs_live {
  hs_live(std::shared_ptr<const hapsim::PreparedBody> prepared,
          const hapsim::ToolLoopOptions& options)
      : body(std::move(prepared)), loop(*body, options) {}
  // What a hand may have of it; without one the force as it is.
  hapsim::Vec3 give(double t, const hapsim::Vec3& tip, const hapsim::Vec3& asked) noexcept {
    force = asked;
    safety = 0;
    if (!hand) return force;
    keep(hand->pass(t, tip, asked));
    return force;
  }
  void keep(const hapsim::SafeSample& sample) noexcept {
    force = sample.force;
    unlimited = sample.unlimited;
    safety = sample.flags;
  }

  std::shared_ptr<const hapsim::PreparedBody> body;
  hapsim::ForceLoop loop;
  std::optional<hapsim::SafeForce> hand;
  hapsim::Vec3 contact = hapsim::Vec3::Zero();  // hs_live_begin()
  hapsim::Vec3 force = hapsim::Vec3::Zero(), unlimited = hapsim::Vec3::Zero();
  int press = 0, safety = 0;
  bool known = false;  // the contact points are: hs_live_begin()
  bool in_air = true;
};

using namespace hapsim;

namespace {

constexpr ChoiceFlag kRecovery{"--recovery"};
constexpr SwitchFlag kHand{"--hand"};

void put(const Vec3& from, double* to) noexcept {
  for (int k = 0; k < 3; ++k) to[k] = from[k];
}

Vec3 vec(const double* from) noexcept {
  return {from[0], from[1], from[2]};
}

double radius_of(const Arguments& arguments, const hs_recording* contacts) {
  if (arguments.given(flag::tool_radius)) return arguments[flag::tool_radius];
  if (contacts == nullptr)
    fail_usage("--tool-radius is required", "give the radius of the tool [m]");
  return contacts->recording.tool_radius();
}

}  // namespace

hs_status hs_prepare(const hs_body* body, const hs_model* model, const hs_recording* contacts,
                     const hs_options* options, hs_prepared** prepared) {
  return made(prepared, [&] {
    std::vector<Option> known = preparation_flags();
    known.push_back(accuracy_option(""));
    known.push_back(
        {.flag = kRecovery, .value = "HOW", .default_text = "none", .choices = {"none", "full"}});
    const Asked asked("hs-simulate", std::move(known), options);
    const Arguments& arguments = asked.arguments();
    const auto say = asked.say();
    for (const std::string& words : doubts_of(model->model)) say(words);
    for (const std::string& words : doubts_of(model->model, std::span(&body->mesh, 1))) say(words);
    ExperimentOptions places = preparation_options(arguments);
    PreparedBodyOptions prepare;
    prepare.tool_radius = contact_radius(model->model, radius_of(arguments, contacts));
    prepare.tolerance = arguments[flag::accuracy];
    prepare.threads = places.threads;
    prepare.cache = places.cache;
    prepare.rim_edge = places.rim_edge;
    prepare.heals = arguments[kRecovery] == "full";
    std::optional<Experiment> fine;
    if (contacts != nullptr) {
      set_poisson_range(model->model, places);
      Recording recording = as_asked(arguments, contacts->recording, false, say);
      set_contact_radius(recording, model->model);
      fine.emplace(make_experiment(body->mesh, std::move(recording), places));
      prepare.contacts = [&](const MaterialSpec& material) {
        return known_contacts(fine->places, material);
      };
    }
    auto handle = std::make_unique<hs_prepared>();
    handle->fitted = fitted_range(model->model.metadata, model->model.name);
    handle->body = std::make_shared<const PreparedBody>(body->mesh, model->model, prepare);
    if (const std::string words = accuracy_words(handle->body->field(), prepare.tolerance);
        !words.empty())
      say(words);
    return handle;
  });
}

void hs_prepared_free(hs_prepared* prepared) {
  delete prepared;
}

double hs_prepared_off_contacts(const hs_prepared* prepared) {
  return prepared->body->field().expected_error();
}

hs_status hs_live_new(const hs_prepared* prepared, const hs_options* options, hs_live** live) {
  return made(live, [&] {
    std::vector<Option> known = safety_flags();
    known.push_back({.flag = kHand});
    const Asked asked("hs-simulate", std::move(known), options);
    ToolLoopOptions loop;
    loop.fitted = prepared->fitted;
    auto handle = std::make_unique<hs_live>(prepared->body, loop);
    if (asked.arguments()[kHand]) handle->hand.emplace(safety_limits(asked.arguments()));
    return handle;
  });
}

void hs_live_free(hs_live* live) {
  delete live;
}

void hs_live_step(hs_live* live, double t, const double tip[3], double force[3]) {
  const Vec3 at = vec(tip);
  live->known = false;
  put(live->give(t, at, live->loop.step(t, at)), force);
}

void hs_live_step_all(hs_live* const* lives, size_t count, double t, const double* tips,
                      double* forces) {
  // Thousands of tools are more than a cache holds: what a step reads first comes meanwhile.
  constexpr std::size_t kAhead = 3, kLines = 16, kLine = 64;
  for (size_t i = 0; i < count; ++i) {
    if (i + kAhead < count) {
      const auto* next = reinterpret_cast<const char*>(lives[i + kAhead]);
      for (std::size_t k = 0; k < kLines; ++k) __builtin_prefetch(next + k * kLine);
    }
    hs_live_step(lives[i], t, tips + 3 * i, forces + 3 * i);
  }
}

void hs_live_begin(hs_live* live, const double contact[3]) {
  live->contact = vec(contact);
  live->known = true;
  ++live->press;
  live->loop.begin(live->contact);
  if (live->hand) live->hand->begin_press();
}

void hs_live_press(hs_live* live, double t, const double u[3], int in_air, double force[3]) {
  const Vec3 by = vec(u);
  live->in_air = in_air != 0;
  put(live->give(t, live->contact + by, live->loop.press(t, by, live->in_air)), force);
}

void hs_live_feel(const hs_live* live, hs_feel* feel) {
  const ToolState& tool = live->loop.tool();
  const bool in_air = live->known ? live->in_air : !tool.touching();
  feel->press = live->known ? live->press : tool.episode;
  feel->contact = in_air ? 0 : 1;
  feel->beyond = live->loop.beyond();
  feel->safety = live->safety;
  put(live->known         ? live->contact
      : tool.episode == 0 ? tool.surface.point
                          : tool.anchor,
      feel->point);
  put(live->loop.pressed(), feel->u);
  put(live->force, feel->force);
  const Vec3& asked = live->hand ? live->unlimited : live->force;
  feel->uncertainty = in_air ? 0 : live->loop.uncertainty() * asked.norm();
  put(asked, feel->asked);
}

void hs_live_set_temperature(hs_live* live, double temperature) {
  live->loop.set_temperature(temperature);
}

void hs_live_miss(hs_live* live, double t, double force[3]) {
  if (live->hand) live->keep(live->hand->miss(t));
  put(live->force, force);
}

void hs_live_end(hs_live* live) {
  if (!live->hand) live->force.setZero();
  if (live->hand) live->keep(live->hand->zero());
}
