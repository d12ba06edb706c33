#include <array>
#include <charconv>
#include <cmath>
#include <optional>

#include "protocol/json_document.h"
#include "protocol/scene_fields.h"
#include "protocol/scene_file.h"

namespace huestep::protocol {

namespace {

/// Small records of numbers stand on one line, and so do lists of points.
template <class T>
inline constexpr bool onOneLine =
    std::is_same_v<T, Vec2> || std::is_same_v<T, Rotation> || std::is_same_v<T, Material> ||
    std::is_same_v<T, Filter> || std::is_same_v<T, SpringDef> || std::is_same_v<T, LimitDef> ||
    std::is_same_v<T, MotorDef> || std::is_same_v<T, RulesParameter>;

/// Grows one text. Fields with their default values are left out: a person sees what is special.
class Writer {
 public:
    std::string take() { return std::move(m_text); }

    void value(bool value) { m_text += value ? "true" : "false"; }
    void value(const std::string& text) { m_text += quoted(text); }
    void value(std::uint32_t number) { m_text += std::to_string(number); }
    void value(std::int32_t number) { m_text += std::to_string(number); }
    void value(float number) {
        // The shortest digits that read back as the same float. A JSON reader may take "-0" for
        // the integer 0 and lose the sign.
        std::array<char, 32> digits{};
        const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
        m_text.append(digits.data(), end);
        if (number == 0.0f && std::signbit(number)) m_text += ".0";
    }
    template <class Enum>
    requires std::is_enum_v<Enum>
    void value(Enum choice) {
        m_text += '"';
        m_text += wordsOf<Enum>[static_cast<std::size_t>(choice)];
        m_text += '"';
    }
    template <class T>
    void value(const std::optional<T>& maybe) {
        value(*maybe);
    }
    template <class T>
    void value(const std::vector<T>& list) {
        entries(list.data(), list.size());
    }
    template <class Struct>
    requires std::is_class_v<Struct>
    void value(const Struct& object);

    template <class T>
    void entries(const T* list, std::size_t size) {
        constexpr std::size_t inlined = std::is_same_v<T, Vec2> ? 1 : 0;
        open('[');
        m_inline += inlined;
        for (std::size_t i = 0; i < size; ++i) {
            next();
            value(list[i]);
        }
        if (m_inline > 0) m_first = true;
        close(']');
        m_inline -= inlined;
    }

    void open(char bracket) {
        m_text += bracket;
        ++m_depth;
        m_first = true;
    }
    void close(char bracket) {
        --m_depth;
        if (!m_first) lineBreak();
        m_text += bracket;
        m_first = false;
    }
    /// Before each entry.
    void next() {
        if (!m_first) m_text += ',';
        lineBreak();
        m_first = false;
    }
    void name(std::string_view name) {
        next();
        m_text += '"';
        m_text += name;
        m_text += "\": ";
    }

 private:
    void lineBreak() {
        if (m_inline > 0) {
            if (!m_first) m_text += ' ';
            return;
        }
        m_text += '\n';
        m_text.append(2 * m_depth, ' ');
    }

    std::string m_text;
    std::size_t m_depth = 0;
    std::size_t m_inline = 0;
    bool m_first = true;
};

/// Writes the fields of one object that differ from those of a fresh one.
template <class Struct>
class FieldWriter {
 public:
    FieldWriter(Writer& writer, const Struct& object) : m_writer(writer), m_object(object) {}

    template <class T>
    void field(std::string_view name, T Struct::*member) {
        if (m_object.*member == m_default.*member) return;
        required(name, member);
    }
    template <class T>
    void required(std::string_view name, T Struct::*member) {
        m_writer.name(name);
        m_writer.value(m_object.*member);
    }
    void vertices(std::string_view name) {
        m_writer.name(name);
        m_writer.entries(m_object.vertices.data(), m_object.vertexCount);
    }

 private:
    Writer& m_writer;
    const Struct& m_object;
    const Struct m_default{};
};

template <class Struct>
requires std::is_class_v<Struct>
void Writer::value(const Struct& object) {
    open('{');
    if constexpr (onOneLine<Struct>) ++m_inline;
    FieldWriter<Struct> fields(*this, object);
    visitFields(fields, std::type_identity<Struct>{});
    if (m_inline > 0) m_first = true;
    close('}');
    if constexpr (onOneLine<Struct>) --m_inline;
}

}  // namespace

std::string writeSceneJson(const Scene& scene) {
    Writer writer;
    writer.open('{');
    writer.name("version");
    writer.value(sceneVersion);
    FieldWriter<Scene> fields(writer, scene);
    visitFields(fields, std::type_identity<Scene>{});
    writer.close('}');
    return writer.take() + '\n';
}

}  // namespace huestep::protocol
