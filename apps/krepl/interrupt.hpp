#pragma once

#include <atomic>

namespace krepl::app {

/// From now on Ctrl-C (SIGINT) and SIGTERM set the returned flag. Work that looks at it ends by itself and reports; if the
/// process is still there 0.6 s later (inside a library that cannot be interrupted), it ends with exit status 130 after its
/// temporary files were removed. Writing to a pipe without reader, or beyond a limit on file sizes, becomes an error of
/// the write instead of the end of the process. Called once, before other threads start.
const std::atomic<bool>& watch_for_interrupts();

/// The caller is about to say that the work was interrupted: the watcher then does not say so again.
void interrupt_is_reported();

constexpr int interrupted_status = 130;

}  // namespace krepl::app
