/// What waits for one viewer: at most one frame, the newest. A viewer that reads slowly sees fewer
/// ticks and never old ones, and costs the server one frame that all viewers share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace huestep::server {

/// One frame of the protocol, shared by those it goes to, behind `room` bytes that the transport
/// fills in anew at each sending.
struct WebFrame {
    std::vector<unsigned char> bytes;
    std::size_t room = 0;
};
using SharedWebFrame = std::shared_ptr<WebFrame>;

class WebViewer {
 public:
    /// Whether a frame of these definitions must bring the shapes: the viewer has others, or none.
    /// Asks about what was handed out, so that a dropped frame's shapes are sent again.
    [[nodiscard]] bool needsShapes(std::uint32_t definitions) const { return m_has != definitions; }

    /// Takes the place of what waits. `definitions` are those of the frame's session.
    void offer(SharedWebFrame frame, std::uint32_t definitions) {
        if (m_waiting) ++m_dropped;
        m_waiting = std::move(frame);
        m_waitingDefinitions = definitions;
    }

    /// The frame to send now; null if none waits.
    SharedWebFrame take() {
        if (m_waiting) m_has = m_waitingDefinitions;
        return std::exchange(m_waiting, nullptr);
    }

    [[nodiscard]] bool waiting() const { return m_waiting != nullptr; }
    [[nodiscard]] std::uint64_t dropped() const { return m_dropped; }

 private:
    SharedWebFrame m_waiting;
    std::uint32_t m_waitingDefinitions = 0;
    std::uint32_t m_has = 0;  ///< definitions handed out last; 0: none, sessions count from 1
    std::uint64_t m_dropped = 0;
};

}  // namespace huestep::server
