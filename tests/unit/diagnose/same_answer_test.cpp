// A diagnosis, a fit and a force depend on what they are given: the same arguments give the same
// bytes, whatever was computed before, beside them, or kept.
#include <gtest/gtest.h>

#include <bit>
#include <future>
#include <string>

#include "diagnose/diagnose.h"
#include "fit/extend.h"
#include "support/synthetic.h"

namespace hapsim {
namespace {

void add(std::string& bytes, const void* data, std::size_t count) {
  bytes.append(static_cast<const char*>(data), count);
}

void add(std::string& bytes, const Eigen::VectorXd& values) {
  add(bytes, values.data(), sizeof(double) * static_cast<std::size_t>(values.size()));
}

// NaN has one form here.
void add(std::string& bytes, double value) {
  const auto bits = std::isnan(value) ? 0x7ff8000000000000u : std::bit_cast<std::uint64_t>(value);
  add(bytes, &bits, sizeof bits);
}

void add(std::string& bytes, const Model& model) {
  for (const Parameter& p : model.parameters) {
    bytes += p.effect + " " + p.name;
    add(bytes, p.value);
    add(bytes, p.std_error);
  }
}

std::string bytes_of(const Diagnosis& d) {
  std::string bytes = verdict_name(d.verdict) + d.explanation;
  for (const Finding& f : d.findings) {
    bytes +=
        f.effect + verdict_name(f.verdict) + f.where + f.evidence + f.fitted + f.next_measurement;
    for (const std::string& other : f.confused_with) bytes += other;
    for (const double value :
         {f.rmse_now.pooled, f.rmse_after.pooled, f.held_out_now.pooled, f.held_out_after.pooled,
          f.p_value, f.criterion_gain, f.memory, f.share})
      add(bytes, value);
  }
  for (const Model& rival : d.rivals) add(bytes, rival);
  return bytes;
}

// Six places on a body with a skin.
Experiment pressed(std::size_t memory, int threads = 0) {
  ExperimentOptions options;
  options.threads = threads;
  options.rim_edge = 0.3;
  options.noise = 0.01;
  options.floor = 0.01;
  options.memory = memory;
  Experiment e =
      make_experiment(test::block_mesh({0.08, 0.08, 0.04}, 6, 6, 4, 1), test::presses(), options);
  test::measure(e, test::with(test::elastic(1.5e4, 0.42), "layer", {0.002, 3}), 0.01, 4);
  return e;
}

DiagnoseOptions few_flips() {
  DiagnoseOptions options;
  options.flips = 99;
  options.folds = 3;
  return options;
}

TEST(SameAnswer, OfADiagnosisByOneThreadAndByMany) {
  std::string first;
  for (const int threads : {1, 2, 5}) {
    const Experiment e = pressed(Memo::kDefaultBudget, threads);
    const Model model = elastic_model(e, all_episodes(e.dataset));
    const std::string bytes = bytes_of(diagnose(model, e, e.allowance(), few_flips()));
    if (first.empty()) first = bytes;
    EXPECT_EQ(bytes, first) << threads << " threads";
  }
}

TEST(SameAnswer, OfADiagnosisAskedTwiceAndInTwoThreads) {
  const Experiment e = pressed(Memo::kDefaultBudget);
  const Model model = elastic_model(e, all_episodes(e.dataset));
  const auto ask = [&] { return bytes_of(diagnose(model, e, e.allowance(), few_flips())); };
  const std::string first = ask();
  EXPECT_EQ(ask(), first) << "asked again";
  auto other = std::async(std::launch::async, ask);
  EXPECT_EQ(ask(), first) << "beside another";
  EXPECT_EQ(other.get(), first) << "in another thread";
  const Experiment fresh = pressed(0);
  EXPECT_EQ(bytes_of(diagnose(model, fresh, fresh.allowance(), few_flips())), first)
      << "of a fresh experiment that keeps nothing";
}

TEST(SameAnswer, OfFitsAndForcesInAnyOrder) {
  const auto answers = [](std::size_t memory, const std::vector<int>& order) {
    const Experiment e = pressed(memory);
    const Selection all = all_episodes(e.dataset);
    const Model elastic = test::elastic(1.5e4, 0.42);
    const std::vector<Model> starts{test::with(elastic, "layer", {0.002, 3}),
                                    test::with(elastic, "layer", {0.004, 2}),
                                    test::with(elastic, "viscoelastic", {5e3, 0.4}), elastic};
    std::vector<std::string> bytes(2 * starts.size());
    for (const int k : order) {
      const auto s = static_cast<std::size_t>(k) / 2;
      if (k % 2 == 0) {
        add(bytes[k], solved_forces(starts[s], e, all, true).f);
        continue;
      }
      FitOptions options{0.01, 0.01, true};
      options.rounds = 2;
      const Fit fitted = fit(starts[s], e, all, options);
      add(bytes[k], fitted.model);
      add(bytes[k], fitted.error.pooled);
      add(bytes[k], model_forces(fitted, e, all, false).f);
    }
    return bytes;
  };
  const auto first = answers(Memo::kDefaultBudget, {0, 1, 2, 3, 4, 5, 6, 7});
  EXPECT_EQ(answers(Memo::kDefaultBudget, {7, 2, 5, 0, 3, 6, 1, 4}), first);
  EXPECT_EQ(answers(20'000'000, {1, 4, 3, 0, 7, 6, 5, 2}), first) << "with room for a few";
  EXPECT_EQ(answers(0, {3, 6, 1, 4, 7, 0, 5, 2}), first) << "with nothing kept";
}

}  // namespace
}  // namespace hapsim
