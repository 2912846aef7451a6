#include "io/stream.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include "expect_error.h"
#include "io/temp_files.h"

namespace hapsim {
namespace {

namespace fs = std::filesystem;

std::string contents(const fs::path& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

class Stream : public testing::Test {
 protected:
  Stream() {
    char name[] = "/tmp/hapsim-test-XXXXXX";
    folder_ = mkdtemp(name);
  }
  ~Stream() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return folder_ / name; }
  std::size_t files() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

  fs::path folder_;
};

TEST_F(Stream, OutputAppearsWhenItIsCommitted) {
  {
    Output out(path("a"));
    out.write("hello ");
    out.stream() << 42;
    EXPECT_FALSE(fs::exists(path("a")));
    out.commit();
  }
  EXPECT_EQ(contents(path("a")), "hello 42");
  EXPECT_EQ(files(), 1u);
}

TEST_F(Stream, OutputWithoutCommitLeavesNothing) {
  {
    Output out(path("a"));
    out.write(std::string(1 << 20, 'x'));
  }
  EXPECT_EQ(files(), 0u);
}

TEST_F(Stream, OldContentStaysUntilCommitAndKeepsItsMode) {
  std::ofstream(path("a")) << "old";
  chmod(path("a").c_str(), 0640);
  Output out(path("a"));
  out.write("new");
  EXPECT_EQ(contents(path("a")), "old");
  out.commit();
  EXPECT_EQ(contents(path("a")), "new");
  struct stat info = {};
  stat(path("a").c_str(), &info);
  EXPECT_EQ(info.st_mode & 0777, 0640u);
}

TEST_F(Stream, OutputFollowsLinks) {
  fs::create_directory(path("d"));
  std::ofstream(path("d/real")) << "old";
  fs::create_symlink("d/real", path("link"));
  Output out(path("link"));
  out.write("new");
  out.commit();
  EXPECT_TRUE(fs::is_symlink(path("link")));
  EXPECT_EQ(contents(path("d/real")), "new");
}

TEST_F(Stream, InputMayBeTheOutput) {
  std::ofstream(path("a")) << "abc";
  Output out(path("a"));
  out.write(Input(path("a")).read_all() + "d");
  out.commit();
  EXPECT_EQ(contents(path("a")), "abcd");
}

TEST_F(Stream, FullDiskIsAnError) {
  Output out("/dev/full");
  EXPECT_EQ(error_of(
                [&] {
                  out.write("x");
                  out.commit();
                },
                ExitCode::kIo),
            "/dev/full: cannot be written: No space left on device; free some space or write "
            "elsewhere");
}

TEST_F(Stream, FailsWhereTheBlockIsWritten) {
  Output out("/dev/full");
  error_of(
      [&] {
        for (int i = 0; i < 1000000; ++i) out.stream() << "many bytes\n";
      },
      ExitCode::kIo);
}

TEST_F(Stream, RefusesWhatCannotBeWritten) {
  error_of([&] { Output(path("none/a")); }, ExitCode::kIo);
  error_of([&] { Output(folder_.string()); }, ExitCode::kIo);
  error_of([&] { Output(path("a/")); }, ExitCode::kIo);
  if (getuid() != 0) {
    std::ofstream(path("read_only")) << "x";
    chmod(path("read_only").c_str(), 0400);
    error_of([&] { Output(path("read_only")); }, ExitCode::kIo);
  }
}

TEST_F(Stream, ManyOutputsHaveTheirOwnFiles) {
  std::vector<std::thread> threads;
  for (int i = 0; i < 8; ++i)
    threads.emplace_back([this] {
      for (int k = 0; k < 20; ++k) {
        Output out(path("same"));
        out.write(std::string(1000, 'x'));
        out.commit();
      }
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(contents(path("same")).size(), 1000u);
  EXPECT_EQ(files(), 1u);
}

TEST_F(Stream, ChildDoesNotRemoveTheParentsFile) {
  Output out(path("a"));
  out.write("x");
  out.stream().flush();
  const pid_t child = fork();
  if (child == 0) {
    clean_up_on_signals();
    raise(SIGTERM);
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status));
  out.commit();
  EXPECT_EQ(contents(path("a")), "x");
}

TEST_F(Stream, SignalRemovesTheTemporaryFile) {
  const pid_t child = fork();
  if (child == 0) {
    clean_up_on_signals();
    Output out(path("a"));
    out.write("x");
    out.stream().flush();
    raise(SIGINT);
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGINT);
  EXPECT_EQ(files(), 0u);
}

TEST_F(Stream, InputReadsLines) {
  Input input = Input::from_bytes("a\n\nb", "memory");
  std::string line;
  EXPECT_TRUE(input.read_line(line));
  EXPECT_EQ(line, "a");
  EXPECT_TRUE(input.read_line(line));
  EXPECT_EQ(line, "");
  EXPECT_TRUE(input.read_line(line));
  EXPECT_EQ(line, "b");
  EXPECT_FALSE(input.read_line(line));
}

TEST_F(Stream, LinesAndStreamShareTheirPlace) {
  std::ofstream(path("a")) << "first\nsecond third\n" << std::string(1 << 20, 'x');
  Input input(path("a"));
  std::string text;
  input.read_line(text);
  input.stream() >> text;
  EXPECT_EQ(text, "second");
  EXPECT_EQ(input.read_all().size(), 7u + (1 << 20));
}

TEST_F(Stream, InputThatIsNotThereIsAnError) {
  EXPECT_NE(error_of([&] { Input(path("none")); }, ExitCode::kIo).find("No such file"),
            std::string::npos);
  Input folder(folder_.string());
  EXPECT_NE(error_of([&] { folder.read_all(); }, ExitCode::kIo).find("Is a directory"),
            std::string::npos);
}

TEST_F(Stream, EndlessLineIsRefused) {
  Input input("/dev/zero");
  std::string line;
  EXPECT_NE(error_of([&] { input.read_line(line); }).find("longer than 64 MB"), std::string::npos);
}

}  // namespace
}  // namespace hapsim
