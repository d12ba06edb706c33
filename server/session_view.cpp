#include "protocol/drawing.h"
#include "server/session.h"

namespace huestep::server {

protocol::View Session::view(bool withShapes) const {
    protocol::View view = protocol::drawingOf(m_world, withShapes, m_limits.drawn);
    view.players = static_cast<std::uint32_t>(m_seats.connected());
    view.definitions = m_definitions;
    return view;
}

}  // namespace huestep::server
