// What presses have not asked: motions without which an effect cannot show, and places.
#include "explore/coverage.h"

#include <gtest/gtest.h>

#include "plan/press_paths.h"

namespace hapsim {
namespace {

Dataset dataset_of(const std::vector<std::size_t>& turns) {
  Recording r;
  r.metadata.set("tool_radius", "0.004");
  int press = 0;
  for (const std::size_t turn : turns) {
    ++press;
    append_press(r, press, 20.0 * press, 0.02, Vec3(0.01 * press, 0, 0), Vec3::UnitZ(),
                 path_in_turn(press_paths(0.002), turn));
  }
  r.f.assign(r.rows(), Vec3::Zero());
  Dataset dataset = make_dataset(std::move(r));
  const std::vector<ToolStand> stands(dataset.positions.size());
  return on_body(std::move(dataset), stands);
}

std::vector<std::string> lacking(const Dataset& dataset) {
  std::vector<std::string> what;
  for (const LackingMotion& m : lacking_motions(dataset)) what.push_back(m.what);
  return what;
}

using Words = std::vector<std::string>;

TEST(Coverage, OfTheFirstMotionsNothingIsLacking) {
  EXPECT_EQ(lacking(dataset_of({0, 1, 2, 3, 4, 5})), Words{});
  EXPECT_EQ(lacking(dataset_of({kHeldTurn, kSidewaysTurn, kSlowTurn})), Words{});
}

TEST(Coverage, EachMotionMakesUpForWhatIsLacking) {
  for (const std::vector<std::size_t>& turns :
       {std::vector<std::size_t>{kSlowTurn, kSlowTurn}, {kHeldTurn}, {kSidewaysTurn}}) {
    const Dataset before = dataset_of(turns);
    std::vector<std::size_t> more = turns;
    for (const LackingMotion& m : lacking_motions(before)) more.push_back(m.turn);
    EXPECT_GT(more.size(), turns.size());
    EXPECT_EQ(lacking(dataset_of(more)), Words{});
  }
}

TEST(Coverage, SlowPressesHaveNoPushHoldOrSecondPace) {
  EXPECT_EQ(lacking(dataset_of({kSlowTurn, kSlowTurn})),
            (Words{"no press moves sideways", "no press is held for a second",
                   "all presses go in at one pace"}));
}

TEST(Coverage, WithoutTimesNothingOfTimeIsAskedFor) {
  Dataset dataset = dataset_of({kSlowTurn});
  Recording r = dataset.recording;
  r.t.clear();
  dataset = make_dataset(std::move(r));
  const std::vector<ToolStand> stands(dataset.positions.size());
  EXPECT_EQ(lacking(on_body(std::move(dataset), stands)), Words{"no press moves sideways"});
}

TEST(Coverage, PlacesCountThatAreAToolsRadiusApart) {
  EXPECT_EQ(places_apart({{0, 0, 0}, {0.001, 0, 0}, {0.005, 0, 0}, {0.006, 0, 0}}, 0.004), 2u);
  EXPECT_EQ(places_apart({}, 0.004), 0u);
  EXPECT_EQ(coverage_of(dataset_of({0, 1, 2})).places, 3u);
}

}  // namespace
}  // namespace hapsim
