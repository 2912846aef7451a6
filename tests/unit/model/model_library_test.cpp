// The library of models: many writers, bad files, and which entry is the nearest.
#include "model/model_library.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "effects/catalogue.h"
#include "expect_error.h"
#include "model/library_use.h"
#include "support/synthetic.h"

namespace hapsim {
namespace {

using Mode = Database::Mode;

class Library : public ::testing::Test {
 protected:
  Library() {
    std::string name = (std::filesystem::temp_directory_path() / "hapsim-library-XXXXXX").string();
    folder_ = mkdtemp(name.data());
    path_ = folder_ / "lab.db";
  }
  ~Library() override { std::filesystem::remove_all(folder_); }

  static Described described(const std::string& material, const std::string& object,
                             double radius) {
    return {material, object, 6e-3, "flat", radius};
  }
  std::filesystem::path folder_, path_;
};

TEST_F(Library, GivesBackWhatWasStored) {
  Model model = test::with(test::elastic(1.5e4, 0.4), "viscoelastic", {8e3, 0.5});
  model.metadata.set("rmse", "0.0123");
  model.parameters[0].std_error = 120;
  {
    ModelLibrary library(path_, Mode::kWrite);
    EXPECT_EQ(library.add(described("liver, pig's", "7", 4e-3), model), 1);
    EXPECT_EQ(library.add(described("", "", 5e-3), test::elastic(1e4, 0.3)), 2);
  }
  ModelLibrary library(path_, Mode::kRead);
  const LibraryEntry entry = library.entry(1);
  EXPECT_EQ(entry.described.material, "liver, pig's");
  EXPECT_EQ(entry.described.tool_radius, 4e-3);
  EXPECT_EQ(entry.stored.size(), 20u);
  EXPECT_EQ(entry.model.metadata.find("rmse").value_or(""), "0.0123");
  EXPECT_EQ(entry.model.find("elastic", 0, "E")->std_error, 120);
  EXPECT_EQ(entry.model.find("viscoelastic", 0, "tau1")->value, 0.5);
  EXPECT_EQ(library.entries().size(), 2u);
}

TEST_F(Library, NumbersAreNeverGivenAgain) {
  ModelLibrary library(path_, Mode::kWrite);
  library.add(described("a", "", 4e-3), test::elastic(1e4, 0.4));
  library.add(described("b", "", 4e-3), test::elastic(1e4, 0.4));
  library.remove({2});
  EXPECT_EQ(library.add(described("c", "", 4e-3), test::elastic(1e4, 0.4)), 3);
  EXPECT_NE(error_of(
                [&] {
                  library.remove({1, 9});
                },
                ExitCode::kUsage)
                .find("has no entry 9"),
            std::string::npos);
  EXPECT_EQ(library.entries().size(), 2u) << "all or none";
}

TEST_F(Library, ManyProcessesWriteAtOnce) {
  constexpr int kProcesses = 6, kEach = 15;
  std::vector<pid_t> children;
  for (int c = 0; c < kProcesses; ++c) {
    const pid_t child = fork();
    if (child == 0) {
      int code = 0;
      try {
        for (int k = 0; k < kEach; ++k)
          ModelLibrary(path_, Mode::kWrite, 60)
              .add(described("m" + std::to_string(c), std::to_string(k), 4e-3),
                   test::elastic(1e4 + k, 0.4));
      } catch (const Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        code = 1;
      }
      _exit(code);
    }
    children.push_back(child);
  }
  for (const pid_t child : children) {
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  }
  EXPECT_EQ(ModelLibrary(path_, Mode::kRead).entries().size(), std::size_t{kProcesses * kEach});
  int files = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder_)) ++files;
  EXPECT_EQ(files, 1) << "no journal is left";
}

TEST_F(Library, AWriterThatDiesLeavesNothingHalfWritten) {
  ModelLibrary(path_, Mode::kWrite).add(described("a", "", 4e-3), test::elastic(1e4, 0.4));
  const pid_t child = fork();
  if (child == 0) {
    ModelLibrary library(path_, Mode::kWrite);
    Database::Transaction transaction(library.database());
    library.add(described("b", "", 4e-3), test::elastic(1e4, 0.4));
    _exit(0);  // without a commit, nor any destructor
  }
  waitpid(child, nullptr, 0);
  EXPECT_EQ(ModelLibrary(path_, Mode::kWrite).entries().size(), 1u);
}

TEST_F(Library, ALibraryThatIsHeldIsWaitedForThenTold) {
  ModelLibrary holder(path_, Mode::kWrite);
  const Database::Transaction transaction(holder.database());
  ModelLibrary other(path_, Mode::kWrite, 0.05);
  const std::string told = error_of(
      [&] { other.add(described("a", "", 4e-3), test::elastic(1e4, 0.4)); }, ExitCode::kIo);
  EXPECT_NE(told.find("another process has held this model library for 0.05 s"), std::string::npos);
}

TEST_F(Library, FilesThatAreNoLibraryAreRefused) {
  const auto refused = [&](Mode mode, ExitCode code) {
    return error_of([&] { ModelLibrary(path_, mode, 0.1); }, code);
  };
  EXPECT_NE(refused(Mode::kRead, ExitCode::kIo).find("cannot be opened"), std::string::npos);
  std::ofstream(path_) << "effect,region,parameter,value\nelastic,0,E,10000\n"
                       << std::string(600, '#');
  EXPECT_NE(refused(Mode::kWrite, ExitCode::kBadInput).find("this is no model library"),
            std::string::npos);
  std::filesystem::remove(path_);
  Database(path_, {"other", 77, 1, "CREATE TABLE entry (id INTEGER)"}, Mode::kWrite);
  for (const Mode mode : {Mode::kRead, Mode::kWrite})
    EXPECT_NE(refused(mode, ExitCode::kBadInput).find("database of another program"),
              std::string::npos);
}

TEST_F(Library, DamageIsTold) {
  {
    ModelLibrary library(path_, Mode::kWrite);
    for (int k = 0; k < 50; ++k) library.add(described("a", "", 4e-3), test::elastic(1e4, 0.4));
  }
  const auto overwrite = [&](std::uintmax_t from, const std::string& bytes) {
    std::fstream file(path_, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(static_cast<std::streamoff>(from));
    file << bytes;
  };
  // SQLite's number of its own format, to which it says neither 'corrupt' nor 'no database'.
  const std::string format{'\0', '\0', '\0', '\4'}, other{'\0', '\0', '\0', '\x63'};
  overwrite(44, other);
  error_of([&] { ModelLibrary(path_, Mode::kRead); });
  overwrite(44, format);
  EXPECT_EQ(ModelLibrary(path_, Mode::kRead).entries().size(), 50u);
  // The middle of the file.
  overwrite(std::filesystem::file_size(path_) / 2, std::string(5000, '\xff'));
  error_of([&] { ModelLibrary(path_, Mode::kWrite).entries(); });
}

TEST_F(Library, ANewerFormatIsLeftAlone) {
  ModelLibrary(path_, Mode::kWrite).add(described("a", "", 4e-3), test::elastic(1e4, 0.4));
  ModelLibrary(path_, Mode::kWrite).database().query("PRAGMA user_version = 2");
  EXPECT_NE(error_of([&] {
              ModelLibrary(path_, Mode::kWrite);
            }).find("has version 2 of its format, and only version 1 is known; use the newer"),
            std::string::npos);
}

TEST_F(Library, AnEntryThatCannotBeReadIsNamed) {
  ModelLibrary(path_, Mode::kWrite).add(described("a", "", 4e-3), test::elastic(1e4, 0.4));
  ModelLibrary(path_, Mode::kWrite)
      .database()
      .query("UPDATE entry SET model = replace(model, 'elastic,0,nu', 'elastic,0,mu')");
  EXPECT_NE(error_of([&] { ModelLibrary(path_, Mode::kRead).entries(); }).find("lab.db: entry 1:"),
            std::string::npos);
}

TEST(NearestEntry, GoesByMaterialThenObjectThenEffectsThenTool) {
  const Model plain = test::elastic(1e4, 0.4);
  const Model relaxing = test::with(plain, "viscoelastic", {8e3, 0.5});
  std::vector<LibraryEntry> entries{
      {1, "", {"liver", "seven", 6e-3, "flat", 4e-3}, plain},
      {2, "", {"liver", "seven", 6e-3, "flat", 8e-3}, relaxing},
      {3, "", {"Liver", "eight", 6e-3, "sphere", 5e-3}, relaxing},
      {4, "", {"foam", "block", 6e-3, "flat", 5e-3}, relaxing},
      {5, "", {"liver", "eight", 6e-3, "sphere", 6e-3}, relaxing},
  };
  const auto nearest = [&](const Described& wanted, const std::vector<std::string>& effects) {
    return nearest_entry(entries, wanted, effects)->id;
  };
  const std::vector<std::string> both{"elastic", "viscoelastic"}, one{"elastic"};
  EXPECT_EQ(nearest({"liver", "seven", 6e-3, "flat", 5e-3}, both), 2)
      << "effects before the radius";
  EXPECT_EQ(nearest({"liver", "seven", 6e-3, "flat", 5e-3}, one), 1) << "no more than asked";
  EXPECT_EQ(nearest({"liver", "", 6e-3, "sphere", 5.1e-3}, both), 3);
  EXPECT_EQ(nearest({"liver", "", 6e-3, "sphere", 5.9e-3}, both), 5);
  EXPECT_EQ(nearest({"", "", 6e-3, "flat", 5e-3}, both), 4) << "nothing told: the tool";
  EXPECT_EQ(nearest_entry({}, {}, both), nullptr);
}

TEST(NearestEntry, ValuesAreTakenWhereBothHaveThem) {
  const Model known = test::with(test::elastic(2e4, 0.45), "viscoelastic", {8e3, 0.5});
  Model start = test::with(test::elastic(1e4, 0.3), "viscoelastic", {1e3, 1});
  start.find("elastic", 0, "nu")->state = ParameterState::kFixed;
  start.find("viscoelastic", 0, "tau1")->lower = 0.7;
  const std::optional<Model> taken = with_values_of(start, known, false);
  ASSERT_TRUE(taken);
  EXPECT_EQ(taken->find("elastic", 0, "E")->value, 2e4);
  EXPECT_EQ(taken->find("elastic", 0, "nu")->value, 0.3) << "fixed";
  EXPECT_EQ(taken->find("viscoelastic", 0, "E1")->value, 8e3);
  EXPECT_EQ(taken->find("viscoelastic", 0, "tau1")->value, 0.7) << "within the bounds";

  Model two = test::elastic(1e4, 0.3);
  for (const Parameter& p : effect_rows(require_effect("viscoelastic"), 2, {1e3, 1, 2e3, 9}))
    two.parameters.push_back(p);
  EXPECT_EQ(with_values_of(two, known, false)->find("viscoelastic", 0, "E1")->value, 1e3)
      << "another number of terms";
  for (const char* name : {"E", "nu"})
    start.find("elastic", 0, name)->state = ParameterState::kFixed;
  for (const char* name : {"E1", "tau1"})
    start.find("viscoelastic", 0, name)->state = ParameterState::kFixed;
  EXPECT_FALSE(with_values_of(start, known, false));
}

class LibraryInUse : public Library {
 protected:
  std::vector<std::string> said_;
  LibraryUse use(double radius = 0.004) {
    return {path_.string(), described("liver", "L1", radius),
            [this](const std::string& text) { said_.push_back(text); }};
  }
};

TEST_F(LibraryInUse, IsMadeWithItsFirstEntry) {
  auto first = use();
  std::vector<Model> starts{test::elastic(1e4, 0.45)};
  first.add_start(starts);
  EXPECT_EQ(starts.size(), 1u);
  EXPECT_FALSE(std::filesystem::exists(path_));
  int commits = 0;
  first.store(test::elastic(1.5e4, 0.4), [&] { ++commits; });
  EXPECT_EQ(commits, 1);
  auto second = use(0.005);
  second.add_start(starts);
  ASSERT_EQ(starts.size(), 2u);  // one more, with the values of the first
  EXPECT_EQ(starts[1].find("elastic", 0, "E")->value, 1.5e4);
  EXPECT_EQ(starts[0].find("elastic", 0, "E")->value, 1e4);
  ASSERT_EQ(said_.size(), 3u);
  for (const std::string& text : said_) EXPECT_EQ(text.rfind(path_.string() + ": ", 0), 0u) << text;
}

TEST_F(LibraryInUse, StaysAsItWasWhenTheModelIsNotWritten) {
  use().store(test::elastic(1e4, 0.45), [] {});
  EXPECT_THROW(use().store(test::elastic(2e4, 0.45), [] { throw std::runtime_error("full"); }),
               std::runtime_error);
  EXPECT_EQ(ModelLibrary(path_, Mode::kRead).entries().size(), 1u);
  ASSERT_EQ(said_.size(), 1u);
}

}  // namespace
}  // namespace hapsim
