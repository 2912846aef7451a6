// What others name and write, and what it may not do.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "expect_error.h"
#include "io/allowed_outputs.h"
#include "io/formula.h"
#include "io/stream.h"

namespace hapsim {
namespace {

namespace fs = std::filesystem;

class AllowedOutputs : public ::testing::Test {
 protected:
  AllowedOutputs() {
    std::string name = (fs::temp_directory_path() / "hapsim-allowed-XXXXXX").string();
    folder_ = mkdtemp(name.data());
    fs::create_directory(folder_ / "files");
    std::ofstream(folder_ / "victim") << "whole";
  }
  ~AllowedOutputs() override {
    unsetenv(kWritesVariable);
    fs::remove_all(folder_);
  }
  void allow(const std::string& names) { setenv(kWritesVariable, names.c_str(), 1); }
  std::string refusal(const fs::path& path) {
    try {
      Output output(path.string());
      output.write("x");
      output.commit();
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }
  fs::path folder_;
};

TEST_F(AllowedOutputs, WithoutAWordAnywhere) {
  unsetenv(kWritesVariable);
  EXPECT_EQ(refusal(folder_ / "victim"), "");
}

TEST_F(AllowedOutputs, OnlyWhatIsNamed) {
  allow((folder_ / "m.csv").string() + "\n" + (folder_ / "files").string() + "/\n/dev/null");
  for (const char* good : {"m.csv", "./m.csv", "files/a.csv", "files/../m.csv"})
    EXPECT_EQ(refusal(folder_ / good), "") << good;
  EXPECT_EQ(refusal("/dev/null"), "");
  fs::create_symlink(folder_ / "victim", folder_ / "files" / "link");
  fs::create_directory_symlink(folder_, folder_ / "files" / "up");
  for (const char* bad : {"victim", "files/../victim", "files/link", "files/up/victim", "files",
                          "filesx", "none/../victim"})
    EXPECT_NE(refusal(folder_ / bad), "") << bad;
  std::ifstream victim(folder_ / "victim");
  std::string text;
  victim >> text;
  EXPECT_EQ(text, "whole");
  allow("");
  EXPECT_NE(refusal(folder_ / "m.csv"), "") << "an empty list names nothing";
}

TEST(Formula, StandsBehindAnApostrophe) {
  for (const char* text : {"=1+1", "+cmd|' /C calc'!A0", "-2+3", "@SUM(1)", "\t=1", "\r=1", " =1"})
    EXPECT_EQ(without_formula(text), "'" + std::string(text)) << text;
  for (const char* text : {"", "liver", "-1.5e3", "+2", "a=b", "  ", "'=1", "-0.004"})
    EXPECT_EQ(without_formula(text), text) << text;
}

}  // namespace
}  // namespace hapsim
