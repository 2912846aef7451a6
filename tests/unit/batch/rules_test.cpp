#include "batch/rules.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "batch/outcome.h"

namespace hapsim {
namespace {

namespace fs = std::filesystem;

class RulesTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = ::testing::TempDir() + "hapsim_rules";
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    for (const char* name : {"a.csv", "b.ply"}) write(name, "x\n");
    batch_ = plan(manifest("x", folder_ + "/a.csv"));
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write(const std::string& file, const std::string& text) const {
    fs::create_directories((fs::path(folder_) / file).parent_path());
    std::ofstream(fs::path(folder_) / file) << text;
  }
  std::string bytes(const std::string& file) const {
    std::ifstream in(fs::path(folder_) / file);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
  }
  Manifest manifest(const std::string& name, const std::string& data) const {
    std::ofstream(folder_ + "/m.csv") << "name,body,data\n" << name << ",b.ply," << data << "\n";
    Input input(folder_ + "/m.csv");
    return read_manifest(input);
  }
  Batch plan(const Manifest& m) const { return plan_batch(m, {folder_ + "/out", false, false}); }
  // As if step.sh had written it, an hour later than all else.
  void fail(int code, const std::string& text) const {
    const std::string file = "out/recordings/x/failure";
    write(file, "model\n" + std::to_string(code) + "\n" + text + "\n");
    fs::last_write_time(fs::path(folder_) / file,
                        fs::file_time_type::clock::now() + std::chrono::hours(1));
  }
  std::string folder_;
  Batch batch_;
};

TEST_F(RulesTest, CommandsAreWrittenOnlyWhenTheyChange) {
  EXPECT_EQ(write_rules(batch_, "", "1").ready, 1U);
  const fs::path script = fs::path(folder_) / "out/recordings/x/model.sh";
  EXPECT_EQ(bytes("out/recordings/x/model.sh").rfind("# hapsim 1\n", 0), 0U);
  EXPECT_NE(bytes("out/recordings/x/model.sh").find("\nexec hs-identify "), std::string::npos);
  EXPECT_NE(
      bytes("out/recordings/x/rules.mk").find("recordings/x/model.csv: recordings/x/model.sh "),
      std::string::npos);
  const auto old = fs::file_time_type::clock::now() - std::chrono::hours(2);
  fs::last_write_time(script, old);
  write_rules(batch_, "", "1");
  EXPECT_EQ(fs::last_write_time(script), old);
  write_rules(batch_, "", "2");
  EXPECT_NE(fs::last_write_time(script), old);
}

TEST_F(RulesTest, WhatWouldFailAgainIsLeftOutUntilSomethingChanges) {
  write_rules(batch_, "", "1");
  fail(3, "hs-identify: a.csv:2: nonsense");
  EXPECT_EQ(write_rules(batch_, "", "1").failed_before, 1U);
  EXPECT_EQ(bytes("out/targets"), "");
  const std::vector<RecordingOutcome> outcomes = read_outcomes(batch_);
  EXPECT_EQ(outcomes[0].state, RecordingState::kFailed);
  EXPECT_EQ(outcomes[0].message, "hs-identify: a.csv:2: nonsense");
  EXPECT_EQ(outcomes[0].command, batch_.steps[0].command);
  fs::last_write_time(fs::path(folder_) / "a.csv",
                      fs::file_time_type::clock::now() + std::chrono::hours(2));
  EXPECT_EQ(write_rules(batch_, "", "1").ready, 1U);
}

TEST_F(RulesTest, WhatAnOtherFileGaveIsRemoved) {
  const std::string model = "out/recordings/x/model.csv";
  write_rules(batch_, "", "1");
  write(model, "m\n");
  write_rules(batch_, "", "1");
  EXPECT_EQ(bytes(model), "m\n");
  // Older than the model: make alone would keep that.
  const auto yesterday = fs::file_time_type::clock::now() - std::chrono::hours(24);
  fs::last_write_time(fs::path(folder_) / "a.csv", yesterday);
  write_rules(batch_, "", "1");
  EXPECT_EQ(bytes(model), "");
}

TEST_F(RulesTest, NothingIsMadeAgainBecauseTheClockWasAhead) {
  write_rules(batch_, "", "1");
  const auto now = fs::file_time_type::clock::now(), ahead = now + std::chrono::hours(3);
  const fs::path script = fs::path(folder_) / "out/recordings/x/model.sh";
  fs::last_write_time(script, ahead);
  write_rules(batch_, "", "1");
  EXPECT_LT(fs::last_write_time(script), now + std::chrono::hours(1));
  EXPECT_NE(bytes("out/recordings/x/rules.mk").find("/a.csv"), std::string::npos);
  fs::last_write_time(fs::path(folder_) / "a.csv", ahead);
  write_rules(batch_, "", "1");
  EXPECT_EQ(bytes("out/recordings/x/rules.mk").find("/a.csv"), std::string::npos);
}

TEST_F(RulesTest, FailuresOfTheMachineAreTriedAgain) {
  write_rules(batch_, "", "1");
  fail(5, "hs-identify: disk full");
  EXPECT_EQ(write_rules(batch_, "", "1").ready, 1U);
  fail(137, "");
  EXPECT_EQ(write_rules(batch_, "", "1").ready, 1U);
  EXPECT_NE(read_outcomes(batch_)[0].message.find("ended by signal 9"), std::string::npos);
}

TEST_F(RulesTest, NamesThatMakeMisreadsAreReachedByALink) {
  write("odd $(x) #1:%.csv", "x\n");
  const Batch odd = plan(manifest("x", "odd $(x) #1:%.csv"));
  ASSERT_FALSE(odd.chain[0].empty());
  write_rules(odd, "", "1");
  const std::string rules = bytes("out/recordings/x/rules.mk");
  EXPECT_EQ(rules.find("odd $(x)"), std::string::npos);
  const std::size_t link = rules.find("links/");
  ASSERT_NE(link, std::string::npos);
  const std::string name = rules.substr(link, rules.find_first_of(" \n", link) - link);
  EXPECT_EQ(bytes("out/" + name), "x\n");
}

TEST_F(RulesTest, WhatIsDoneIsReadBack) {
  write_rules(batch_, "", "1");
  EXPECT_EQ(read_outcomes(batch_)[0].state, RecordingState::kNotRun);
  write("out/recordings/x/model.csv",
        "# rmse: 0.02\n# heldout: 0.03\n# force_noise: 0.01\n"
        "effect,region,parameter,value\nelastic,0,E,9000\nelastic,0,nu,0.4\ntip,0,kappa,9\n");
  const RecordingOutcome o = read_outcomes(batch_)[0];
  EXPECT_EQ(o.state, RecordingState::kDone);
  EXPECT_EQ(o.effects, "elastic+tip");
  EXPECT_EQ(o.modulus, "9000");
  EXPECT_DOUBLE_EQ(o.held_out, 0.03);
  EXPECT_EQ(read_outcomes(plan(manifest("x", folder_ + "/b.ply")))[0].state,
            RecordingState::kNotRun);
  write("a.csv", "other\n");
  EXPECT_EQ(read_outcomes(batch_)[0].state, RecordingState::kNotRun);
  write_rules(batch_, "", "1");
  write("out/recordings/x/model.csv", "nonsense\n");
  EXPECT_EQ(read_outcomes(batch_)[0].state, RecordingState::kFailed);
}

}  // namespace
}  // namespace hapsim
