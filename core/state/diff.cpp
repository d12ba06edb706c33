// Where two worlds differ: the field list once more, record by record.

#include <charconv>
#include <cstring>

#include "core/rules/rules.h"
#include "core/world/world_data.h"

namespace huestep {

namespace {

std::string valueText(const std::byte* at, FieldType type) {
    char text[64];
    std::to_chars_result end{};
    const auto read = [at](auto value) {
        std::memcpy(&value, at, sizeof value);
        return value;
    };
    switch (type) {
        case FieldType::F32:
            end = std::to_chars(text, text + sizeof text, read(0.0f));
            break;
        case FieldType::U32:
            end = std::to_chars(text, text + sizeof text, read(0u));
            break;
        case FieldType::I32:
            end = std::to_chars(text, text + sizeof text, read(0));
            break;
        case FieldType::U64:
            end = std::to_chars(text, text + sizeof text, read(std::uint64_t{0}));
            break;
        case FieldType::U16:
            end = std::to_chars(text, text + sizeof text, read(std::uint16_t{0}));
            break;
        case FieldType::U8:
            end = std::to_chars(text, text + sizeof text, read(std::uint8_t{0}));
            break;
        case FieldType::I8:
            end = std::to_chars(text, text + sizeof text, int{read(std::int8_t{0})});
            break;
    }
    return {text, end.ptr};
}

template <class Record>
bool compareFields(const Record& a, const Record& b, Difference& out) {
    const auto* left = reinterpret_cast<const std::byte*>(&a);
    const auto* right = reinterpret_cast<const std::byte*>(&b);
    for (const Field& field : fieldsOf<Record>) {
        for (std::uint32_t k = 0; k < field.count; ++k) {
            const std::uint32_t offset = field.offset + k * sizeOf(field.type);
            if (std::memcmp(left + offset, right + offset, sizeOf(field.type)) == 0) continue;
            out.field = field.name;
            if (field.count > 1) out.field += "[" + std::to_string(k) + "]";
            out.left = valueText(left + offset, field.type);
            out.right = valueText(right + offset, field.type);
            return true;
        }
    }
    return false;
}

/// What a record of an array is called, and which body it belongs to.
void nameRecord(const WorldState& s, std::string_view array, std::size_t i, Difference& out) {
    const auto name = [&](std::string_view kind, std::uint64_t id) {
        out.name = std::string(kind) + " " + std::to_string(id);
    };
    out.record = array;
    if (array == "motion" || array == "body") {
        out.body = s.bodies[i].id;
        name("body", out.body);
    } else if (array == "shape") {
        out.body = s.shapes[i].body;
        name("shape", s.shapes[i].id);
    } else if (array == "joint" || array == "jointImpulse") {
        out.body = s.joints[i].bodyB;
        name("joint", s.joints[i].id);
    } else if (array == "player") {
        name("player", s.players[i].id);
    } else if (array == "contact") {
        const ContactState& c = s.contacts[i];
        for (const ShapeInfo& shape : s.shapes) {
            if (shape.id == c.shapeA) out.body = shape.body;
        }
        out.name = "contact " + std::to_string(c.shapeA) + "-" + std::to_string(c.shapeB);
    } else if (array == "world" || array == "rules") {
        out.name = array;
    } else {
        name(array, i);
    }
}

/// The field of the rules' state that a word is part of, by the name that the rules give it.
void nameRulesField(const World& left, const World& right, std::size_t word, Difference& out) {
    const std::span<const std::byte> a = left.rulesState();
    const std::span<const std::byte> b = right.rulesState();
    out.record = out.name = "rules";
    for (const Field& field : left.rules()->fields()) {
        const std::uint32_t size = sizeOf(field.type);
        for (std::uint32_t k = 0; k < field.count; ++k) {
            const std::size_t offset = field.offset + std::size_t{k} * size;
            if (offset + size <= word * sizeof(RulesWord)) continue;
            if (std::memcmp(&a[offset], &b[offset], size) == 0) continue;
            out.field = field.name;
            if (field.count > 1) out.field += "[" + std::to_string(k) + "]";
            out.left = valueText(&a[offset], field.type);
            out.right = valueText(&b[offset], field.type);
            return;
        }
    }
}

}  // namespace

std::string Difference::sentence() const {
    return name + " " + field + ": " + left + " here, " + right + " there";
}

std::optional<Difference> firstDifference(const World& left, const World& right) {
    left.m_data->contactsToState();
    right.m_data->contactsToState();
    const WorldState& a = left.m_data->state;
    const WorldState& b = right.m_data->state;
    std::optional<Difference> found;

    const auto compareArray = [&](std::string_view array, const auto& one, const auto& other) {
        for (std::size_t i = 0; !found && i < one.size() && i < other.size(); ++i) {
            Difference d;
            if (compareFields(one[i], other[i], d)) {
                nameRecord(a, array, i, d);
                const bool same = left.rules() == right.rules() && left.rules() != nullptr;
                if (array == "rulesWord" && same) nameRulesField(left, right, i, d);
                found = d;
            }
        }
        if (found || one.size() == other.size()) return;
        Difference d;
        const bool more = one.size() > other.size();
        nameRecord(more ? a : b, array, std::min(one.size(), other.size()), d);
        d.field = "present";
        d.left = more ? "yes" : "no";
        d.right = more ? "no" : "yes";
        found = d;
    };
    // The first name is enough: the visit walks both states in step.
    forEachArray(a, [&](std::string_view array, const auto& one) {
        forEachArray(b, [&](std::string_view same, const auto& other) {
            if constexpr (std::is_same_v<decltype(one), decltype(other)>) {
                if (!found && same == array) compareArray(array, one, other);
            }
        });
    });
    return found;
}

}  // namespace huestep
