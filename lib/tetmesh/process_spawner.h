// Processes that are forked from a small one: private to tetgen_child.cpp.
#pragma once

#include <sys/types.h>

#include <optional>

namespace hapsim {

// A worker, seen from the process that asked for it. When it goes away the worker is ended.
class Worker {
 public:
  Worker(int data, int told, pid_t process) : data_(data), told_(told), process_(process) {}
  Worker(Worker&& other) noexcept;
  Worker(const Worker&) = delete;
  ~Worker();
  int data() const { return data_; }  // a stream in both directions
  pid_t process() const { return process_; }
  // Its status as waitpid() has it. Unless it `ended` by itself it is killed.
  int finish(bool ended);

 private:
  int data_, told_;  // `told_` brings its status
  pid_t process_;
};

// Forks workers. A fork copies the tables of all the memory that a process has, and each page that
// is written afterwards is copied too: from a process that holds many prepared contacts that takes
// longer than a small mesh. So they are forked from one that was forked when there was little; it
// has one thread, so no worker inherits a lock that another thread held, and none of our files. It
// ends when its parent does, however that ends, and its workers with it.
class ProcessSpawner {
 public:
  // In the worker: `work` gets its end of the stream and never returns.
  using Work = void (*)(int data);
  explicit ProcessSpawner(Work work);
  ProcessSpawner(const ProcessSpawner&) = delete;
  ~ProcessSpawner();
  // Nothing where there is none, `patience` [s] waited for. Error(kIo): no sockets.
  std::optional<Worker> spawn(double patience);

 private:
  int control_ = -1;
  pid_t process_ = -1;
};

}  // namespace hapsim
