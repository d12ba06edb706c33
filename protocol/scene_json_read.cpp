#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>
#include <vector>

#include "core/math/trig.h"
#include "protocol/json_document.h"
#include "protocol/plain_text.h"
#include "protocol/scene_fields.h"
#include "protocol/scene_file.h"
#include "protocol/scene_json.h"
#include "protocol/trail.h"

namespace huestep::protocol {

namespace {

using Kind = JsonValue::Kind;

void expect(Trail& trail, const JsonValue& json, Kind kind) {
    if (json.kind == kind) return;
    trail.refuse("must be " + std::string(nameOf(kind)) + ", is " + std::string(nameOf(json.kind)));
}

void read(Trail& trail, const JsonValue& json, bool& out) {
    expect(trail, json, Kind::Boolean);
    out = json.boolean;
}

void read(Trail& trail, const JsonValue& json, std::string& out) {
    expect(trail, json, Kind::String);
    if (!isPlainText(json.text)) trail.refuse("must be text without control characters");
    out = json.text;
}

void read(Trail& trail, const JsonValue& json, float& out) {
    expect(trail, json, Kind::Number);
    const char* end = json.text.data() + json.text.size();
    const auto parsed = std::from_chars(json.text.data(), end, out);
    if (parsed.ec == std::errc{} && parsed.ptr == end && std::isfinite(out)) return;
    // Too large and too small are told apart by a look at the wider number.
    const double wide = std::strtod(json.text.c_str(), nullptr);
    if (!(std::abs(wide) < 1.0)) {
        trail.refuse(json.text.substr(0, 40) + " is beyond the range of 32-bit floats");
    }
    out = static_cast<float>(wide);
}

template <class Whole>
void readWhole(Trail& trail, const JsonValue& json, Whole& out) {
    expect(trail, json, Kind::Number);
    const char* end = json.text.data() + json.text.size();
    const auto parsed = std::from_chars(json.text.data(), end, out);
    if (parsed.ec == std::errc{} && parsed.ptr == end) return;
    trail.refuse("must be a whole number from " +
                 std::to_string(std::numeric_limits<Whole>::min()) + " to " +
                 std::to_string(std::numeric_limits<Whole>::max()) + ", is " +
                 json.text.substr(0, 40));
}
void read(Trail& trail, const JsonValue& json, std::uint32_t& out) {
    readWhole(trail, json, out);
}
void read(Trail& trail, const JsonValue& json, std::int32_t& out) {
    readWhole(trail, json, out);
}

template <class Enum>
requires std::is_enum_v<Enum>
void read(Trail& trail, const JsonValue& json, Enum& out) {
    expect(trail, json, Kind::String);
    std::string known;
    for (std::size_t i = 0; i < wordsOf<Enum>.size(); ++i) {
        if (json.text == wordsOf<Enum>[i]) {
            out = static_cast<Enum>(i);
            return;
        }
        known += i == 0 ? "" : ", ";
        known += wordsOf<Enum>[i];
    }
    trail.refuse(quoted(json.text.substr(0, 40)) + " is none of " + known);
}

void read(Trail& trail, const JsonValue& json, Rotation& out);
template <class Struct>
requires std::is_class_v<Struct>
void read(Trail& trail, const JsonValue& json, Struct& out);
template <class T>
void read(Trail& trail, const JsonValue& json, std::vector<T>& out);

template <class T>
void read(Trail& trail, const JsonValue& json, std::optional<T>& out) {
    read(trail, json, out.emplace());
}

/// Takes the fields of one object, and refuses what is left over.
template <class Struct>
class FieldReader {
 public:
    FieldReader(Trail& trail, const JsonValue& json, Struct& out)
        : m_trail(trail), m_json(json), m_out(out) {
        expect(trail, json, Kind::Object);
    }

    template <class T>
    void field(std::string_view name, T Struct::*member) {
        m_known.push_back(name);
        const JsonValue* json = m_json.find(name);
        if (json == nullptr) return;
        m_trail.at(name, [&] { read(m_trail, *json, m_out.*member); });
    }

    template <class T>
    void required(std::string_view name, T Struct::*member) {
        if (m_json.find(name) == nullptr) m_trail.refuse(name, "is missing");
        field(name, member);
    }

    void vertices(std::string_view name) {
        m_known.push_back(name);
        const JsonValue* json = m_json.find(name);
        if (json == nullptr) m_trail.refuse(name, "is missing");
        std::vector<Vec2> points;
        m_trail.at(name, [&] { expect(m_trail, *json, Kind::Array); });
        if (json->entries.size() > m_out.vertices.size()) {
            m_trail.refuse(name, std::to_string(json->entries.size()) + " are more than " +
                                     std::to_string(m_out.vertices.size()));
        }
        for (std::size_t i = 0; i < json->entries.size(); ++i) {
            m_trail.at(name, i, [&] { read(m_trail, json->entries[i], m_out.vertices[i]); });
        }
        m_out.vertexCount = static_cast<std::uint8_t>(json->entries.size());
    }

    /// A field that is read elsewhere.
    void known(std::string_view name) { m_known.push_back(name); }

    void finish() {
        for (const std::string& key : m_json.keys) {
            bool found = false;
            std::string names;
            for (const std::string_view name : m_known) {
                found = found || key == name;
                names += names.empty() ? "" : ", ";
                names += name;
            }
            if (found) continue;
            const std::string shown = key.substr(0, 40);
            m_trail.refuse(shown, "no such field; there are " + names);
        }
    }

 private:
    Trail& m_trail;
    const JsonValue& m_json;
    Struct& m_out;
    std::vector<std::string_view> m_known;
};

template <class Struct>
requires std::is_class_v<Struct>
void read(Trail& trail, const JsonValue& json, Struct& out) {
    FieldReader<Struct> reader(trail, json, out);
    visitFields(reader, std::type_identity<Struct>{});
    reader.finish();
}

/// A rotation is (cos, sin), exact; or, for people, an angle.
void read(Trail& trail, const JsonValue& json, Rotation& out) {
    expect(trail, json, Kind::Object);
    if (json.find("angle") == nullptr) {
        FieldReader<Rotation> reader(trail, json, out);
        visitFields(reader, std::type_identity<Rotation>{});
        reader.known("angle");
        reader.finish();
        return;
    }
    if (json.find("c") != nullptr || json.find("s") != nullptr) {
        trail.refuse("has both an angle and c or s");
    }
    struct Angle {
        float angle = 0.0f;  // rad
    } turn;
    FieldReader<Angle> reader(trail, json, turn);
    reader.required("angle", &Angle::angle);
    reader.finish();
    constexpr float most = 1.0e6f;
    if (!(std::abs(turn.angle) <= most)) trail.refuse("angle", "must be within 1000000 of 0");
    out = rotationOf(turn.angle);
}

template <class T>
void read(Trail& trail, const JsonValue& json, std::vector<T>& out) {
    expect(trail, json, Kind::Array);
    out.resize(json.entries.size());
    for (std::size_t i = 0; i < out.size(); ++i) {
        trail.atIndex(i, [&] { read(trail, json.entries[i], out[i]); });
    }
}

void readVersion(Trail& trail, const JsonValue& json) {
    const JsonValue* version = json.find("version");
    if (version == nullptr) {
        trail.refuse("version",
                     "is missing; this program reads version " + std::to_string(sceneVersion));
    }
    std::uint32_t number = 0;
    trail.at("version", [&] {
        read(trail, *version, number);
        if (number != sceneVersion) {
            trail.refuse("is " + std::to_string(number) + ", this program reads version " +
                         std::to_string(sceneVersion));
        }
    });
}

}  // namespace

Result<Scene> readSceneJson(std::span<const std::byte> text) {
    const Result<JsonValue> document = parseJson(text);
    if (!document) return document.error();
    Trail trail("");
    try {
        if (document->kind != Kind::Object) {
            trail.refuse("a scene must be an object, this is " +
                         std::string(nameOf(document->kind)));
        }
        readVersion(trail, *document);
        Scene scene;
        FieldReader<Scene> reader(trail, *document, scene);
        reader.known("version");
        visitFields(reader, std::type_identity<Scene>{});
        reader.finish();
        return scene;
    } catch (const Refused& refused) {
        return Error{refused.sentence};
    }
}

}  // namespace huestep::protocol
