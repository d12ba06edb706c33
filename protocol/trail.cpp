#include "protocol/trail.h"

#include <algorithm>

namespace huestep::protocol {

std::string Trail::where() const {
    std::string path(m_root);
    for (std::size_t i = 0; i < std::min(m_depth, m_steps.size()); ++i) {
        if (!path.empty()) path += '.';
        path += m_steps[i].field;
        if (m_steps[i].index == noIndex) continue;
        path += '[';
        path += std::to_string(m_steps[i].index);
        path += ']';
    }
    return path;
}

std::string Trail::sentence(const std::string& reason) const {
    std::string text = where();
    if (!text.empty()) text += ": ";
    return text += reason;
}

}  // namespace huestep::protocol
