// METIS orders while signals come: they reach the program's handler, in whatever thread.
#include "linalg/metis_guard.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "laplacian.h"

namespace hapsim {
namespace {

std::atomic<int> received{0};

TEST(MetisGuard, SignalsReachTheProgramsHandlerWhileAnotherThreadOrders) {
  struct sigaction action = {}, before = {}, after = {};
  action.sa_handler = [](int) { ++received; };
  action.sa_flags = SA_RESTART;
  sigaction(SIGTERM, &action, &before);
  const SymmetricSparse a = laplacian(24);
  const double quiet = SparseCholesky(a, 1).factor_nonzeros();
  std::atomic<bool> done{false};
  std::vector<double> nonzeros;
  std::thread worker([&] {
    for (int i = 0; i < 6; ++i) nonzeros.push_back(SparseCholesky(a, 1).factor_nonzeros());
    done = true;
  });
  int sent = 0;
  while (!done) {
    kill(getpid(), SIGTERM);
    ++sent;
    while (received < sent) std::this_thread::yield();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  worker.join();
  sigaction(SIGTERM, &before, &after);
  EXPECT_GT(sent, 5);
  EXPECT_EQ(received, sent);
  EXPECT_EQ(after.sa_flags & SA_RESTART, SA_RESTART) << "the handler was put back as another";
  for (const double n : nonzeros) EXPECT_EQ(n, quiet) << "the ordering was left";
}

}  // namespace
}  // namespace hapsim
