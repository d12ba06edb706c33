#include "protocol/scene_file.h"

#include <algorithm>
#include <array>

#include "core/state/hash.h"
#include "protocol/bytes.h"
#include "protocol/scene_json.h"
#include "protocol/wire/scene_wire.h"

namespace huestep::protocol {

namespace {

// The binary form: {magic, u32 version, u32 zero, u64 payload bytes, u64 XXH3 of the payload's XXH3
// and the bytes before}, then one flat Cap'n Proto segment. The magic's first byte begins no JSON
// text, and its last turns into something else where a transfer meddles with line ends.
constexpr std::array<char, 8> magic{'\x89', 'H', 'S', 'C', 'E', 'N', 'E', '\n'};
constexpr std::size_t fileHeaderBytes = 32;

std::uint64_t checksumOf(std::span<const std::byte> file) {
    std::array<std::byte, 32> front{};
    std::copy_n(file.begin(), 24, front.begin());
    store(std::span(front), 24, hash64(file.subspan(fileHeaderBytes)));
    return hash64(front);
}

Result<Scene> readBinary(std::span<const std::byte> file) {
    if (file.size() < fileHeaderBytes || load<std::array<char, 8>>(file, 0) != magic) {
        return Error{"byte 0: neither JSON nor a binary scene file"};
    }
    if (const auto version = load<std::uint32_t>(file, 8); version != sceneVersion) {
        return Error{"version: is " + std::to_string(version) + ", this program reads version " +
                     std::to_string(sceneVersion)};
    }
    const auto payloadBytes = load<std::uint64_t>(file, 16);
    if (payloadBytes != file.size() - fileHeaderBytes) {
        return Error{"byte 16: the header tells of " + std::to_string(payloadBytes) +
                     " bytes, the file has " + std::to_string(file.size() - fileHeaderBytes)};
    }
    if (load<std::uint64_t>(file, 24) != checksumOf(file)) {
        return Error{"byte 24: the checksum does not match: the file is not what was written"};
    }
    return wire::readMessage<schema::Scene, Scene>(
        "", file.subspan(fileHeaderBytes),
        [](wire::Reading& in, schema::Scene::Reader root) { return wire::readScene(in, root); });
}

}  // namespace

Result<Scene> readScene(std::span<const std::byte> bytes) {
    if (bytes.empty()) return Error{"the file is empty"};
    if (bytes.size() > maxSceneFileBytes) {
        return Error{"the file has " + std::to_string(bytes.size()) + " bytes, at most " +
                     std::to_string(maxSceneFileBytes) + " are read"};
    }
    const bool binary = static_cast<char>(bytes[0]) == magic[0];
    Result<Scene> scene = binary ? readBinary(bytes) : readSceneJson(bytes);
    if (!scene) return scene;
    if (Status status = check(*scene); !status) return status.error();
    return scene;
}

std::vector<std::byte> writeSceneBinary(const Scene& scene) {
    const std::size_t words = 1 + wire::structWords<schema::Scene>() + wire::contentWords(scene);
    std::vector<std::byte> file = wire::writeMessage<schema::Scene>(
        fileHeaderBytes, words, [&](auto root) { wire::put(root, scene); });
    const std::span<std::byte> to(file);
    store(to, 0, magic);
    store(to, 8, sceneVersion);
    store(to, 16, static_cast<std::uint64_t>(file.size() - fileHeaderBytes));
    store(to, 24, checksumOf(file));
    return file;
}

}  // namespace huestep::protocol
