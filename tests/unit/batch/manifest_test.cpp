#include "batch/manifest.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>

#include "batch/chain.h"
#include "expect_error.h"

namespace hapsim {
namespace {

// Two files in a folder of their own, and a manifest beside them.
class ManifestTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = ::testing::TempDir() + "hapsim_manifest/";
    std::filesystem::create_directories(folder_);
    for (const char* name : {"a.csv", "b.ply", "s.csv"}) std::ofstream(folder_ + name) << "x\n";
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  Manifest read(const std::string& text) const {
    Input input = Input::from_bytes(text, folder_ + "m.csv");
    return read_manifest(input);
  }
  std::string problem(const std::string& row) const {
    return read("name,body,scan,data,tool,options\n" + row + "\n").rows[0].problem;
  }
  std::string folder_;
};

TEST_F(ManifestTest, RowsAreReadWithTheirPathsFromHere) {
  const Manifest m = read(
      "name,body,data,tool,effects,options,weight\nliver 3,b.ply,a.csv,4mm,elastic + tip,--fix "
      "'nu=0.4',80\n");
  ASSERT_EQ(m.rows.size(), 1U);
  const ManifestRow& row = m.rows[0];
  EXPECT_EQ(row.problem, "");
  EXPECT_EQ(row.line, 2);
  EXPECT_EQ(row.data, folder_ + "a.csv");
  EXPECT_EQ(row.body, folder_ + "b.ply");
  EXPECT_DOUBLE_EQ(row.tool_radius, 0.004);
  EXPECT_EQ(row.effects, "elastic,tip");
  EXPECT_EQ(options_of(row, "model"), (std::vector<std::string>{"--fix", "nu=0.4"}));
  EXPECT_EQ(m.extra_header, std::vector<std::string>{"weight"});
  EXPECT_EQ(row.extra, std::vector<std::string>{"80"});
}

TEST_F(ManifestTest, FilesInOptionsAreFromItsFolderAndRead) {
  const Manifest m = read(
      "name,scan,data,options,common_options,tetmesh_options,compare_options\n"
      "x,s.csv,a.csv,--data=a.csv --history h.csv,--rim-edge 0.3,--order 2 --region b.ply --fixed "
      "bottom+file:s.csv,--simulated old=a.csv\n"
      "y,s.csv,a.csv,--data gone.csv,,,\n");
  const ManifestRow& row = m.rows[0];
  EXPECT_EQ(row.problem, "");
  EXPECT_EQ(options_of(row, "model"),
            (std::vector<std::string>{"--data=" + folder_ + "a.csv", "--history", "h.csv"}));
  EXPECT_EQ(options_of(row, "body"),
            (std::vector<std::string>{"--order", "2", "--region", folder_ + "b.ply", "--fixed",
                                      "bottom+file:" + folder_ + "s.csv"}));
  EXPECT_EQ(options_of(row, "report"),
            (std::vector<std::string>{"--simulated", "old=" + folder_ + "a.csv"}));
  const Batch batch = plan_batch(m, {});
  for (const BatchStep& step : batch.steps) {
    if (step.name == "body") {
      EXPECT_EQ(step.given, (std::vector<std::string>{folder_ + "b.ply", folder_ + "s.csv"}));
    }
    if (step.name == "model") {
      EXPECT_EQ(step.given, (std::vector<std::string>{folder_ + "a.csv", folder_ + "a.csv"}));
    }
  }
  EXPECT_NE(m.rows[1].problem.find("gone.csv': No such file"), std::string::npos);
}

TEST_F(ManifestTest, ARowsFaultIsItsOwn) {
  EXPECT_EQ(problem("x,b.ply,,a.csv,,"), "");
  for (const auto& [row, what] : std::vector<std::pair<std::string, std::string>>{
           {",b.ply,,a.csv,,", "has no name"},
           {"x,b.ply,s.csv,a.csv,,", "exclude each other"},
           {"x,,,a.csv,,", "neither body nor scan"},
           {"x,b.ply,,,,", "no data are named"},
           {"x,b.ply,,gone.csv,,", "No such file"},
           {"x,.,,a.csv,,", "is a folder"},
           {"x,b.ply,,a.csv,-4mm,", "not between 0 and 1 m"},
           {"x,b.ply,,a.csv,four,", "is no length"},
           {"x,b.ply,,a.csv,,--fix '", "never closes"}}) {
    EXPECT_NE(problem(row).find("m.csv:2: "), std::string::npos) << problem(row);
    EXPECT_NE(problem(row).find(what), std::string::npos) << problem(row);
  }
  const Manifest twice = read("name,body,data\nx,b.ply,a.csv\ny,b.ply,a.csv\nx,b.ply,a.csv\n");
  EXPECT_EQ(twice.rows[1].problem, "");
  EXPECT_NE(twice.rows[2].problem.find("m.csv:4: the name 'x' stands in line 2"),
            std::string::npos);
}

TEST_F(ManifestTest, FoldersArePlainAndApart) {
  EXPECT_EQ(plain_name("liver_3.b-2"), "liver_3.b-2");
  std::set<std::string> names;
  for (const char* text :
       {"a b", "a_b", "a-b", "a/b", "a  b", "", ".", "..", "../a", "a'b", "ä", "-"})
    names.insert(plain_name(text));
  EXPECT_EQ(names.size(), 12U);
  for (const std::string& name : names) {
    EXPECT_EQ(name.find_first_of(" /'$"), std::string::npos) << name;
    EXPECT_NE(name[0], '.') << name;
  }
  EXPECT_LT(plain_name(std::string(5000, 'x')).size(), 120U);
}

TEST_F(ManifestTest, EqualScansShareTheirBody) {
  const Manifest m = read(
      "name,scan,data,tetmesh_options\na,s.csv,a.csv,\nb,s.csv,a.csv,\nc,s.csv,a.csv,--order 2\n");
  const Batch batch = plan_batch(m, {"out", true, true});
  ASSERT_EQ(batch.chain.size(), 3U);
  EXPECT_EQ(batch.chain[0].size(), 7U);  // points, surface, body, model, diagnosis, forces, report
  EXPECT_EQ(batch.chain[0][2], batch.chain[1][2]);
  EXPECT_NE(batch.chain[0][2], batch.chain[2][2]);
  EXPECT_EQ(batch.steps.size(), 3U * 2 + 4U * 3);
  const BatchStep& model = batch.steps[static_cast<std::size_t>(batch.chain[1][3])];
  EXPECT_EQ(model.output, "recordings/b/model.csv");
  EXPECT_NE(model.command.find("--threads 1"), std::string::npos);
  EXPECT_EQ(model.made.size(), 1U);
  EXPECT_EQ(plan_batch(m, {"out", false, false}).chain[0].size(), 4U);
}

TEST_F(ManifestTest, TablesOfMachinesAreImportedFirst) {
  const Manifest m = read(
      "name,raw,scan,data,import_options,tool\nblock,a.csv,,,--block 60x50x40mm,4mm\n"
      "scanned,a.csv,s.csv,,,\nboth,a.csv,s.csv,a.csv,,\nbare,a.csv,,,--unit mm,\n");
  const Batch batch = plan_batch(m, {"out", false, false});
  ASSERT_EQ(batch.chain[0].size(), 3U);  // data, body, model
  const BatchStep& data = batch.steps[static_cast<std::size_t>(batch.chain[0][0])];
  EXPECT_EQ(data.output, "recordings/block/data.csv");
  for (const char* words : {"hs-import ", "--surface out/recordings/block/block.ply",
                            "--tool-radius 0.004", "--block 60x50x40mm"})
    EXPECT_NE(data.command.find(words), std::string::npos) << data.command;
  const BatchStep& model = batch.steps[static_cast<std::size_t>(batch.chain[0][2])];
  EXPECT_EQ(model.made,
            (std::vector<std::string>{"recordings/block/data.csv", "recordings/block/body.ply"}));
  EXPECT_EQ(model.command.rfind("hs-identify out/recordings/block/data.csv --body", 0), 0U);
  EXPECT_EQ(batch.chain[1].size(), 5U);  // data, points, surface, body, model
  EXPECT_NE(m.rows[2].problem.find("data and raw exclude"), std::string::npos);
  EXPECT_NE(m.rows[3].problem.find("--block in import_options"), std::string::npos);
}

TEST_F(ManifestTest, WholeManifestsAreRefused) {
  EXPECT_NE(error_of([&] { read("name,body,dat\nx,b.ply,a.csv\n"); }).find("'data' is missing"),
            std::string::npos);
  EXPECT_NE(error_of([&] { read("name,data\nx,a.csv\n"); }).find("neither a column"),
            std::string::npos);
  EXPECT_NE(error_of([&] {
              read("name,body,data,option\nx,b.ply,a.csv,\n");
            }).find("did you mean 'options'"),
            std::string::npos);
  EXPECT_NE(error_of([&] { read("name,body,data\n"); }).find("no rows"), std::string::npos);
}

}  // namespace
}  // namespace hapsim
