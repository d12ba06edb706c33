#include "tools/progress.h"

#include <unistd.h>

#include <cstdio>

#include "tools/clock.h"

namespace huestep::tools {
namespace {

constexpr std::uint64_t drawEvery = 100'000'000;  // ns: ten times a second is smooth enough

}  // namespace

Progress::Progress(std::string what, std::uint64_t total)
    : m_what(std::move(what)), m_total(total), m_shown(isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() {
    clear();
}

void Progress::clear() const {
    if (m_shown) std::fputs("\r\033[K", stderr);
}

void Progress::advance(std::uint64_t steps) {
    const std::uint64_t done = m_done.fetch_add(steps) + steps;
    if (!m_shown) return;
    // Whoever moves the time of the next drawing forward is the one that draws.
    const std::uint64_t now = nanoseconds();
    std::uint64_t due = m_nextDraw.load();
    if (now >= due && m_nextDraw.compare_exchange_strong(due, now + drawEvery)) draw(done);
}

void Progress::draw(std::uint64_t done) {
    constexpr int width = 40;
    const double share =
        m_total == 0 ? 1.0 : static_cast<double>(done) / static_cast<double>(m_total);
    const int filled = static_cast<int>(share * width);
    std::string bar(static_cast<std::size_t>(width), '.');
    for (int i = 0; i < filled && i < width; ++i) bar[static_cast<std::size_t>(i)] = '#';
    std::fprintf(stderr, "\r%s [%s] %3.0f %%\033[K", m_what.c_str(), bar.c_str(), 100.0 * share);
    std::fflush(stderr);
}

}  // namespace huestep::tools
