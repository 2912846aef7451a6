#include "tetmesh/process_spawner.h"

#include <dirent.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstring>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

namespace hapsim {
namespace {

// Does as the first byte says: 'e'cho of the next one, 'c'rash, 's'leep, how many 'f'iles are open.
[[noreturn]] void obey(int stream) {
  char order = 0, next = 0;
  if (read(stream, &order, 1) != 1) _exit(9);
  if (order == 'c') raise(SIGSEGV);
  if (order == 's') sleep(1000);
  if (order == 'e' && read(stream, &next, 1) != 1) _exit(9);
  if (order == 'f') {
    DIR* folder = opendir("/proc/self/fd");
    for (const dirent* entry; (entry = readdir(folder)) != nullptr;)
      next += entry->d_name[0] != '.';
  }
  _exit(write(stream, &next, 1) == 1 ? 7 : 9);
}

char ask(Worker& worker, const char* words) {
  EXPECT_EQ(write(worker.data(), words, std::strlen(words)),
            static_cast<ssize_t>(std::strlen(words)));
  char answer = 0;
  EXPECT_EQ(read(worker.data(), &answer, 1), 1);
  return answer;
}

// Not one that has ended and that nobody has waited for yet.
bool is_there(pid_t process) {
  std::ifstream file("/proc/" + std::to_string(process) + "/stat");
  std::string number, name;
  char state = 'X';
  file >> number >> name >> state;
  return state != 'X' && state != 'Z';
}

bool goes_away(pid_t process) {
  for (int i = 0; i < 1000 && is_there(process); ++i) usleep(10'000);
  return !is_there(process);
}

TEST(ProcessSpawner, WorkersAnswerAndSayHowTheyEnded) {
  ProcessSpawner spawner(obey);
  auto one = spawner.spawn(10), other = spawner.spawn(10);
  ASSERT_TRUE(one && other);
  EXPECT_EQ(ask(*other, "ey"), 'y');
  EXPECT_EQ(ask(*one, "ex"), 'x');
  const int status = one->finish(true);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 7);

  auto third = spawner.spawn(10);
  ASSERT_TRUE(third);
  EXPECT_EQ(write(third->data(), "c", 1), 1);
  char none;
  EXPECT_EQ(read(third->data(), &none, 1), 0);
  const int crashed = third->finish(true);
  EXPECT_TRUE(WIFSIGNALED(crashed) && WTERMSIG(crashed) == SIGSEGV);
}

TEST(ProcessSpawner, ServesManyThreadsAtOnce) {
  ProcessSpawner spawner(obey);
  std::vector<std::thread> threads;
  for (char c = 'a'; c < 'i'; ++c)
    threads.emplace_back([&spawner, c] {
      const char words[] = {'e', c, 0};
      for (int i = 0; i < 10; ++i) {
        auto worker = spawner.spawn(60);
        ASSERT_TRUE(worker);
        EXPECT_EQ(ask(*worker, words), c);
      }
    });
  for (std::thread& thread : threads) thread.join();
}

// Who waits for the end of a pipe of ours must not wait for a worker: the standard streams, its own
// and the folder that it reads are all it has.
TEST(ProcessSpawner, WorkersHaveNoneOfOurFiles) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  ProcessSpawner spawner(obey);
  auto worker = spawner.spawn(10);
  ASSERT_TRUE(worker);
  EXPECT_EQ(ask(*worker, "f"), 5);
  for (const int end : ends) close(end);
}

TEST(ProcessSpawner, AWorkerThatIsNotWaitedForIsKilled) {
  ProcessSpawner spawner(obey);
  pid_t process = 0;
  {
    auto worker = spawner.spawn(10);
    ASSERT_TRUE(worker);
    process = worker->process();
    EXPECT_EQ(write(worker->data(), "s", 1), 1);
    EXPECT_TRUE(is_there(process));
  }
  EXPECT_TRUE(goes_away(process));
}

TEST(ProcessSpawner, AllEndWithTheirParentHoweverItEnds) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const pid_t parent = fork();
  if (parent == 0) {
    ProcessSpawner spawner(obey);
    auto worker = spawner.spawn(10);
    const pid_t process = worker ? worker->process() : 0;
    if (write(worker->data(), "s", 1) != 1 || write(ends[1], &process, sizeof process) < 0)
      _exit(1);
    sleep(1000);
    _exit(1);
  }
  close(ends[1]);
  pid_t worker = 0;
  ASSERT_EQ(read(ends[0], &worker, sizeof worker), static_cast<ssize_t>(sizeof worker));
  ASSERT_TRUE(worker > 0 && is_there(worker));
  kill(parent, SIGKILL);
  waitpid(parent, nullptr, 0);
  EXPECT_TRUE(goes_away(worker));
  close(ends[0]);
}

}  // namespace
}  // namespace hapsim
