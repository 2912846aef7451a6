#include "io/temp_files.h"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>

#include "io/system_error.h"

namespace hapsim {
namespace {

// What the signal handler reads: fixed memory, no locks. `owner` is the process that made the file,
// 0 while the slot is free, -1 while its path is being written.
struct Slot {
  std::atomic<int> owner{0};
  char path[4096];
};

std::array<Slot, 64> slots;
std::atomic<unsigned> serial{0};
static_assert(std::atomic<int>::is_always_lock_free);

extern "C" void remove_and_end(int signal_number) {
  const int saved = errno;
  const int self = getpid();
  for (Slot& slot : slots)
    if (slot.owner.load() == self) unlink(slot.path);
  errno = saved;
  raise(signal_number);  // SA_RESETHAND has restored the default; it takes effect on return
}

int claim_slot(const std::string& path) {
  if (path.size() >= sizeof(Slot::path)) return -1;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    int free = 0;
    if (!slots[i].owner.compare_exchange_strong(free, -1)) continue;
    std::memcpy(slots[i].path, path.c_str(), path.size() + 1);
    slots[i].owner.store(getpid());
    return static_cast<int>(i);
  }
  return -1;
}

}  // namespace

void clean_up_on_signals() {
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGQUIT, SIGXCPU, SIGABRT, SIGSEGV,
                           SIGBUS, SIGFPE, SIGILL}) {
    struct sigaction action = {};
    if (sigaction(number, nullptr, &action) != 0 || action.sa_handler != SIG_DFL) continue;
    action.sa_handler = remove_and_end;
    action.sa_flags = static_cast<int>(SA_RESETHAND);
    sigaction(number, &action, nullptr);
  }
  signal(SIGXFSZ, SIG_IGN);
}

TempFile::TempFile(const std::string& folder, const std::string& target) {
  do {
    path_ =
        folder + "/.hapsim-" + std::to_string(getpid()) + "-" + std::to_string(serial++) + ".tmp";
    // Registered first, so that no signal finds the file unknown.
    slot_ = claim_slot(path_);
    fd_ = uninterrupted(
        [&] { return open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666); });
    if (fd_ < 0 && slot_ >= 0) slots[static_cast<std::size_t>(slot_)].owner.store(0);
  } while (fd_ < 0 && errno == EEXIST);
  if (fd_ < 0) fail_system(target, "cannot be created", errno);
}

TempFile::~TempFile() {
  const auto slot = static_cast<std::size_t>(slot_);
  const bool ours = slot_ < 0 || slots[slot].owner.load() == getpid();
  if (!kept_ && ours) unlink(path_.c_str());
  if (slot_ >= 0) slots[slot].owner.store(0);
}

}  // namespace hapsim
