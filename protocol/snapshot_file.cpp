#include <algorithm>

#include "core/state/hash.h"
#include "protocol/bytes.h"
#include "protocol/codec.h"
#include "protocol/journal_format.h"

namespace huestep::protocol::journal {

namespace {

constexpr std::array<char, 8> snapshotMagic{'H', 'S', 'T', 'E', 'P', 'S', 'N', 'P'};
constexpr std::uint32_t snapshotVersion = 1;
constexpr std::size_t headerSize = 40;
constexpr std::size_t hashedHeader = 32;
/// Small enough to say where the damage is, large enough that the table is 0.2 % of the file.
constexpr std::size_t blockBytes = 4'096;

std::size_t blocksOf(std::uint64_t imageBytes) {
    return static_cast<std::size_t>((imageBytes + blockBytes - 1) / blockBytes);
}

/// The hash that header and table have; the bytes of the hash itself lie between them.
std::uint64_t frontHash(std::span<const std::byte> file, std::size_t tableBytes) {
    std::vector<std::byte> front(file.begin(), file.begin() + hashedHeader);
    const auto table = file.subspan(headerSize, tableBytes);
    front.insert(front.end(), table.begin(), table.end());
    return hash64(front);
}

std::span<const std::byte> block(std::span<const std::byte> image, std::size_t index) {
    const std::size_t start = index * blockBytes;
    return image.subspan(start, std::min(blockBytes, image.size() - start));
}

}  // namespace

std::vector<std::byte> wrapSnapshot(std::uint64_t tick, std::span<const std::byte> image) {
    const std::size_t blocks = blocksOf(image.size());
    std::vector<std::byte> file(headerSize + 8 * blocks + image.size());
    const std::span<std::byte> to(file);
    store(to, 0, snapshotMagic);
    store(to, 8, snapshotVersion);
    store(to, 12, static_cast<std::uint32_t>(blockBytes));
    store(to, 16, tick);
    store(to, 24, static_cast<std::uint64_t>(image.size()));
    for (std::size_t i = 0; i < blocks; ++i) {
        store(to, headerSize + 8 * i, hash64(block(image, i)));
    }
    store(to, hashedHeader, frontHash(file, 8 * blocks));
    std::copy(image.begin(), image.end(),
              file.begin() + static_cast<std::ptrdiff_t>(headerSize + 8 * blocks));
    return file;
}

Result<std::vector<std::byte>> unwrapSnapshot(std::uint64_t tick, std::span<const std::byte> file) {
    if (file.size() < headerSize) {
        return Error{"byte 0: " + std::to_string(file.size()) +
                     " bytes are too few for a snapshot's header of 40"};
    }
    if (load<std::array<char, 8>>(file, 0) != snapshotMagic) {
        return Error{"byte 0: this is no snapshot"};
    }
    if (const auto version = load<std::uint32_t>(file, 8); version != snapshotVersion) {
        return Error{"byte 8: snapshot version " + std::to_string(version) +
                     ", this program reads " + std::to_string(snapshotVersion)};
    }
    const auto imageBytes = load<std::uint64_t>(file, 24);
    const std::size_t tableBytes = imageBytes > maxSnapshotBytes ? 0 : 8 * blocksOf(imageBytes);
    const bool sizesHold = imageBytes <= maxSnapshotBytes &&
                           load<std::uint32_t>(file, 12) == blockBytes &&
                           file.size() == headerSize + tableBytes + imageBytes;
    if (!sizesHold) {
        return Error{"byte 24: the file's " + std::to_string(file.size()) +
                     " bytes do not fit the image of " + std::to_string(imageBytes) +
                     " bytes that its header tells of"};
    }
    if (load<std::uint64_t>(file, hashedHeader) != frontHash(file, tableBytes)) {
        return Error{"byte 0: the header and table (bytes 0 to " +
                     std::to_string(headerSize + tableBytes - 1) + ") are not what was written"};
    }
    if (const auto own = load<std::uint64_t>(file, 16); own != tick) {
        return Error{"byte 16: the snapshot is of tick " + std::to_string(own) +
                     ", which is not what the file is called"};
    }
    const auto image = file.subspan(headerSize + tableBytes);
    for (std::size_t i = 0; i < blocksOf(imageBytes); ++i) {
        if (load<std::uint64_t>(file, headerSize + 8 * i) == hash64(block(image, i))) continue;
        const std::size_t start = headerSize + tableBytes + i * blockBytes;
        return Error{"bytes " + std::to_string(start) + " to " +
                     std::to_string(start + block(image, i).size() - 1) +
                     " are not what was written"};
    }
    return std::vector<std::byte>(image.begin(), image.end());
}

}  // namespace huestep::protocol::journal
