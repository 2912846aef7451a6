// Places at which the tool does not fit on the body are left out and counted, or borrow a
// neighbour's stiffness; parts of an experiment are what they were in it.
#include <gtest/gtest.h>

#include "base/error.h"
#include "experiment/forces.h"
#include "support/synthetic.h"

namespace hapsim {
namespace {

Recording at_places(const std::vector<Vec3>& places) {
  Recording r;
  r.name = "places";
  r.metadata.set("tool_radius", "0.004");
  for (std::size_t p = 0; p < places.size(); ++p)
    for (int k = 1; k <= 3; ++k) {
      r.line.push_back(static_cast<long>(r.line.size()) + 2);
      r.press.push_back(static_cast<int>(p));
      r.position.push_back(places[p]);
      const double inwards = places[p].z() > 0 ? -1 : 1;
      r.u.emplace_back(0, 0, inwards * 5e-4 * k);
      r.f.emplace_back(0, 0, -inwards * 0.1 * k);
    }
  return r;
}

const std::vector<Vec3> kPlaces{{0.03, 0.03, 0.04}, {0.05, 0.04, 0.04}, {0.06, 0.04, 0.0}};

Experiment prepared(const std::vector<Vec3>& places, bool borrow) {
  ExperimentOptions options;
  options.rim_edge = 0.35;
  options.nu_low = options.nu_high = 0.4;
  options.borrow = borrow;
  return make_experiment(test::block_mesh({0.08, 0.08, 0.04}, 6, 6, 4, 1), at_places(places),
                         options);
}

TEST(UnfitPlaces, AreLeftOutAndCounted) {
  // The third lies on the bonded bottom.
  const Experiment w = prepared(kPlaces, false);
  EXPECT_EQ(w.dataset.positions.size(), 2);
  EXPECT_EQ(w.dataset.episodes.size(), 2);
  EXPECT_EQ(w.dataset.rows(), 6);
  ASSERT_EQ(w.unfit.size(), 1);
  EXPECT_EQ(w.unfit[0].point, kPlaces[2]);
  EXPECT_NE(left_out_words(w).front().find("1 of 3 places are left out"), std::string::npos)
      << left_out_words(w).front();
  const Experiment borrowed = prepared(kPlaces, true);
  EXPECT_EQ(borrowed.dataset.rows(), 9);
  EXPECT_EQ(borrowed.places.size(), 3);
  EXPECT_EQ(borrowed.unfit.size(), 1);
  EXPECT_TRUE(borrowed.places.unfit(2).empty());
}

// A press of 45 mm on a body of 40 mm.
Experiment prepared_with_through(std::vector<Vec3> places) {
  Recording r = at_places(places);
  r.u[1].z() = -0.045;
  ExperimentOptions options;
  options.rim_edge = 0.35;
  options.nu_low = options.nu_high = 0.4;
  return make_experiment(test::block_mesh({0.08, 0.08, 0.04}, 6, 6, 4, 1), std::move(r), options);
}

TEST(UnfitPlaces, AreThoseWherePressesComeThrough) {
  const Experiment w = prepared_with_through({kPlaces[0], kPlaces[1], {0.03, 0.05, 0.04}});
  EXPECT_EQ(w.dataset.rows(), 6);
  ASSERT_EQ(w.unfit.size(), 1);
  EXPECT_NE(left_out_words(w).front().find("places:3: a displacement of 0.045 m goes through"),
            std::string::npos)
      << left_out_words(w).front();
  EXPECT_NEAR(w.depth.depth, 1.5e-3, 1e-9);
  EXPECT_EQ(w.depth.line, 7);
  EXPECT_THROW(prepared_with_through({kPlaces[0]}), Error);
}

TEST(UnfitPlaces, AreFatalWhereThereIsNoOther) {
  EXPECT_THROW(prepared({kPlaces[2]}, false), Error);
  EXPECT_THROW(prepared({kPlaces[2]}, true), Error);
}

TEST(UnfitPlaces, PartsOfAnExperimentHaveItsForces) {
  const Experiment w = prepared({kPlaces[0], kPlaces[1]}, false);
  const Experiment part = at_positions(w, {1});
  const Model model = test::elastic(1e4, 0.4);
  const Eigen::VectorXd all = solved_forces(model, w, all_episodes(w.dataset), false).f;
  EXPECT_EQ(solved_forces(model, part, all_episodes(part.dataset), false).f, all.tail(9));
  EXPECT_EQ(part.dataset.recording.u,
            std::vector<Vec3>(w.dataset.recording.u.begin() + 3, w.dataset.recording.u.end()));
}

}  // namespace
}  // namespace hapsim
