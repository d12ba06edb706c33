/// Ctrl-C and SIGTERM as a question that long loops ask.
#pragma once

#include <atomic>

namespace huestep::tools {

/// From now on the first SIGINT or SIGTERM only sets `interrupted()`; a second one ends the
/// program at once.
void catchInterrupts();

[[nodiscard]] bool interrupted();

/// What `interrupted` reads, for whoever watches a flag.
[[nodiscard]] std::atomic<bool>& interruptFlag();

/// What a signal tells beside setting `interrupted()`.
class InterruptHook {
 public:
    virtual ~InterruptHook() = default;
    /// Called by the handler: only what a signal handler may do. May be called more than once.
    virtual void interrupt() = 0;
};

/// While it lives, a signal calls the hook, and one that came before has called it: so none is
/// lost between `catchInterrupts` and a loop's own handlers. One at a time.
class HookedInterrupt {
 public:
    explicit HookedInterrupt(InterruptHook& hook);
    ~HookedInterrupt();
    HookedInterrupt(const HookedInterrupt&) = delete;
    HookedInterrupt& operator=(const HookedInterrupt&) = delete;
};

}  // namespace huestep::tools
