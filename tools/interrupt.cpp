#include "tools/interrupt.h"

#include <csignal>

namespace huestep::tools {
namespace {

// A signal handler can reach nothing but globals, and of those only lock-free atomics.
std::atomic<bool> g_interrupted{false};
std::atomic<InterruptHook*> g_hook{nullptr};
static_assert(std::atomic<bool>::is_always_lock_free);
static_assert(std::atomic<InterruptHook*>::is_always_lock_free);

void onSignal(int signal) {
    g_interrupted = true;
    std::signal(signal, SIG_DFL);
    if (InterruptHook* hook = g_hook.load()) hook->interrupt();
}

}  // namespace

void catchInterrupts() {
    std::signal(SIGINT, onSignal);
    std::signal(SIGTERM, onSignal);
}

bool interrupted() {
    return g_interrupted;
}

std::atomic<bool>& interruptFlag() {
    return g_interrupted;
}

HookedInterrupt::HookedInterrupt(InterruptHook& hook) {
    g_hook = &hook;
    // A signal that came before found no hook.
    if (interrupted()) hook.interrupt();
}

HookedInterrupt::~HookedInterrupt() {
    g_hook = nullptr;
}

}  // namespace huestep::tools
