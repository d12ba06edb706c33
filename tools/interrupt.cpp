#include "tools/interrupt.h"

#include <csignal>

namespace huestep::tools {
namespace {

// A signal handler can reach nothing but a global of this type.
volatile std::sig_atomic_t g_interrupted = 0;

void onSignal(int signal) {
    g_interrupted = 1;
    std::signal(signal, SIG_DFL);
}

}  // namespace

void catchInterrupts() {
    std::signal(SIGINT, onSignal);
    std::signal(SIGTERM, onSignal);
}

bool interrupted() {
    return g_interrupted != 0;
}

}  // namespace huestep::tools
