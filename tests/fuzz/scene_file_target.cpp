/// Scene files in both forms.
///
/// An input that starts with 'B' is also taken as the payload of a binary file whose header is
/// right: bytes 1 to 7 are skipped.
#include "core/state/hash.h"
#include "protocol/bytes.h"
#include "protocol/scene_file.h"
#include "tests/fuzz/target.h"

namespace {

using namespace huestep;
using huestep::fuzz::require;

void readTwice(std::span<const std::byte> file) {
    const auto scene = protocol::readScene(file);
    if (!scene) {
        require(!scene.error().message.empty(), "a refusal has a sentence");
        return;
    }
    const std::string json = protocol::writeSceneJson(*scene);
    const auto fromJson = protocol::readScene(std::as_bytes(std::span(json.data(), json.size())));
    require(fromJson.ok(), "our own text is accepted");
    require(*fromJson == *scene, "text reads back equal");
    const auto fromBinary = protocol::readScene(protocol::writeSceneBinary(*scene));
    require(fromBinary.ok(), "our own binary form is accepted");
    require(*fromBinary == *scene, "the binary form reads back equal");
}

/// The payload under a header that fits it, as protocol/scene_file.cpp lays it out.
std::vector<std::byte> binaryFile(std::span<const std::byte> payload) {
    std::vector<std::byte> file = protocol::writeSceneBinary(Scene{});
    file.resize(32);
    file.insert(file.end(), payload.begin(), payload.end());
    protocol::store(std::span(file), 16, static_cast<std::uint64_t>(payload.size()));
    std::vector<std::byte> front(file.begin(), file.begin() + 24);
    front.resize(32);
    protocol::store(std::span(front), 24, hash64(payload));
    protocol::store(std::span(file), 24, hash64(front));
    return file;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto bytes = huestep::fuzz::bytesOf(data, size);
    readTwice(bytes);
    if (size > 8 && data[0] == 'B') readTwice(binaryFile(bytes.subspan(8)));
    return 0;
}
