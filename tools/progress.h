/// A progress bar on standard error: on a terminal only, none in a pipe.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>

namespace huestep::tools {

/// Thread rule: `advance` from any thread; the rest from one. Gone from the terminal when
/// destroyed.
class Progress {
 public:
    Progress(std::string what, std::uint64_t total);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    void advance(std::uint64_t steps = 1);
    void clear() const;  ///< until the next drawing: for a line of text in its place

 private:
    void draw(std::uint64_t done);
    std::string m_what;
    std::uint64_t m_total;
    bool m_shown;
    std::atomic<std::uint64_t> m_done{0};
    std::atomic<std::uint64_t> m_nextDraw{0};  ///< ns of the clock
};

}  // namespace huestep::tools
