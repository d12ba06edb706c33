#include "core/rules/rules.h"

#include <algorithm>
#include <array>
#include <charconv>

namespace huestep {

namespace {

/// The shortest digits that read back as the same number. `std::to_string` would bring the C
/// library's formatted output with it, and a module for pages that imports files.
std::string text(float value) {
    std::array<char, 64> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
    return {digits.data(), end};
}

}  // namespace

float RulesParameters::take(std::string_view name, float standard, float low, float high) {
    m_known.push_back(name);
    const auto given = std::find_if(m_given.begin(), m_given.end(),
                                    [&](const RulesParameter& p) { return p.name == name; });
    if (given == m_given.end()) return standard;
    if (given->value >= low && given->value <= high) return canonicalZero(given->value);
    if (m_problem.empty()) {
        m_problem = "parameter " + std::string(name) + ": must be from " + text(low) + " to " +
                    text(high) + ", is " + text(given->value);
    }
    return standard;
}

std::uint32_t RulesParameters::takeWhole(std::string_view name, std::uint32_t standard,
                                         std::uint32_t low, std::uint32_t high) {
    const float value =
        take(name, static_cast<float>(standard), static_cast<float>(low), static_cast<float>(high));
    const auto whole = static_cast<std::uint32_t>(value);
    if (static_cast<float>(whole) != value && m_problem.empty()) {
        m_problem =
            "parameter " + std::string(name) + ": must be a whole number, is " + text(value);
    }
    return whole;
}

Status RulesParameters::verdict() const {
    if (!m_problem.empty()) return Error{m_problem};
    for (const RulesParameter& given : m_given) {
        if (std::find(m_known.begin(), m_known.end(), given.name) != m_known.end()) continue;
        std::string sentence = "there is no parameter " + given.name + "; there are";
        for (const std::string_view name : m_known) sentence += " " + std::string(name);
        return Error{sentence};
    }
    return Done{};
}

Result<const Rules*> findRules(RulesSet known, std::string_view name, std::uint32_t version) {
    std::string there;
    for (const Rules* const rules : known) {
        if (rules->name() == name && rules->version() == version) return rules;
        there += (there.empty() ? "" : ", ") + std::string(rules->name()) + " " +
                 std::to_string(rules->version());
    }
    return Error{"this build does not have the rules " + std::string(name) + " " +
                 std::to_string(version) + "; it has " + (there.empty() ? "none" : there)};
}

}  // namespace huestep
