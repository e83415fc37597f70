#include "interrupt.hpp"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <thread>

#include "output/atomic_file.hpp"

namespace krepl::app {

namespace {

std::atomic<bool> interrupted{false}, reported{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler sets it");
int wake_pipe[2] = {-1, -1};

constexpr int grace_milliseconds = 600;  // the promise is one second, also on a busy machine

extern "C" void on_interrupt(int) {
  int number = errno;
  interrupted.store(true, std::memory_order_relaxed);
  if (wake_pipe[1] >= 0 && ::write(wake_pipe[1], "", 1) < 0) {
    // The pipe is full: the watcher has been woken long ago.
  }
  errno = number;
}

/// Sleeps until the first signal, then gives the rest of the program its time to end in order.
void watch() {
  char byte;
  while (::read(wake_pipe[0], &byte, 1) < 0 && errno == EINTR) {
  }
  ::poll(nullptr, 0, grace_milliseconds);
  output::abandon_temporary_files();
  if (!reported.exchange(true))
    std::fputs(::isatty(STDERR_FILENO) != 0 ? "\r\033[Kkrepl: interrupted\n" : "krepl: interrupted\n", stderr);
  ::_exit(interrupted_status);
}

void handle(int signal_number) {
  struct sigaction action {};
  action.sa_handler = on_interrupt;
  sigemptyset(&action.sa_mask);
  action.sa_flags = 0;  // no SA_RESTART: a read from a terminal or pipe must return
  sigaction(signal_number, &action, nullptr);
}

}  // namespace

void interrupt_is_reported() { reported.store(true); }

const std::atomic<bool>& watch_for_interrupts() {
  signal(SIGPIPE, SIG_IGN);
  signal(SIGXFSZ, SIG_IGN);
  if (::pipe2(wake_pipe, O_CLOEXEC) == 0) {
    // The watcher must not take the signals: they have to interrupt reads of the main thread.
    sigset_t both, before;
    sigemptyset(&both);
    sigaddset(&both, SIGINT);
    sigaddset(&both, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &both, &before);
    std::thread(watch).detach();
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
  }
  handle(SIGINT);
  handle(SIGTERM);
  return interrupted;
}

}  // namespace krepl::app
