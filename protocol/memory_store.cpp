#include "protocol/memory_store.h"

#include <algorithm>

namespace huestep::protocol {

namespace {

constexpr std::size_t sector = 512;

/// SplitMix64 (Steele, Lea and Flood 2014): a sequence of numbers from a seed.
std::uint64_t nextRandom(std::uint64_t& state) {
    std::uint64_t z = state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

}  // namespace

Error MemoryStore::failed(const std::string& name, const char* what) const {
    return Error{describe(name) + ": cannot " + what + ": the disk does not answer"};
}

bool MemoryStore::survives() {
    const std::uint64_t number = m_changes++;
    return !m_diesAt || number < *m_diesAt;
}

void MemoryStore::dieAfter(std::uint64_t changes) {
    m_diesAt = m_changes + changes;
}
void MemoryStore::revive() {
    m_diesAt.reset();
}

std::uint64_t MemoryStore::totalBytes() const {
    std::uint64_t bytes = 0;
    for (const auto& [name, file] : m_files) bytes += file.data.size();
    return bytes;
}

Result<MemoryStore::File*> MemoryStore::find(const std::string& name, const char* what) {
    if (!isPlainFileName(name)) return Error{"'" + name + "' is not a plain file name"};
    if (m_diesAt && m_changes > *m_diesAt) return failed(name, what);
    const auto found = m_files.find(name);
    if (found == m_files.end()) {
        return Error{describe(name) + ": cannot " + what + ": No such file or directory"};
    }
    return &found->second;
}

Result<std::vector<std::string>> MemoryStore::list() {
    if (m_diesAt && m_changes > *m_diesAt) return failed("", "list");
    std::vector<std::string> names;
    for (const auto& [name, file] : m_files) names.push_back(name);
    return names;
}

Result<std::vector<std::byte>> MemoryStore::read(const std::string& name) {
    const Result<File*> file = find(name, "open");
    if (!file) return file.error();
    return (*file)->data;
}

Status MemoryStore::append(const std::string& name, std::span<const std::byte> bytes) {
    const Result<File*> file = find(name, "open");
    if (!file) return file.error();
    std::vector<std::byte>& data = (*file)->data;
    const auto take = [&](std::size_t size) {
        data.insert(data.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    };
    if (!survives()) {
        std::uint64_t state = m_changes;
        take(static_cast<std::size_t>(nextRandom(state) % (bytes.size() + 1)));
        return failed(name, "write");
    }
    const std::uint64_t used = totalBytes();
    if (m_capacity && used + bytes.size() > *m_capacity) {
        take(static_cast<std::size_t>(*m_capacity - std::min(*m_capacity, used)));
        return Error{describe(name) + ": cannot write: No space left on device"};
    }
    take(bytes.size());
    return Done{};
}

Status MemoryStore::sync(const std::string& name) {
    const Result<File*> file = find(name, "open");
    if (!file) return file.error();
    if (!survives()) return failed(name, "sync");
    if (m_failingSyncs) return Error{describe(name) + ": cannot sync: Input/output error"};
    if (!m_lyingSyncs) (*file)->synced = (*file)->data.size();
    return Done{};
}

Status MemoryStore::truncate(const std::string& name, std::uint64_t size) {
    const Result<File*> file = find(name, "open");
    if (!file) return file.error();
    if (!survives()) return failed(name, "shorten");
    (*file)->data.resize(static_cast<std::size_t>(size));
    (*file)->synced = std::min((*file)->synced, (*file)->data.size());
    return Done{};
}

Status MemoryStore::replace(const std::string& name, std::span<const std::byte> bytes) {
    if (!isPlainFileName(name)) return Error{"'" + name + "' is not a plain file name"};
    if (!survives()) return failed(name, "open");
    if (m_failingSyncs) return Error{describe(name) + ": cannot sync: Input/output error"};
    // The old file is there until the new one is complete, so both must fit.
    if (m_capacity && totalBytes() + bytes.size() > *m_capacity) {
        return Error{describe(name) + ": cannot write: No space left on device"};
    }
    File& file = m_files[name];
    file.data.assign(bytes.begin(), bytes.end());
    file.synced = m_lyingSyncs ? 0 : file.data.size();
    return Done{};
}

Status MemoryStore::remove(const std::string& name) {
    const Result<File*> file = find(name, "remove");
    if (!file) return file.error();
    if (!survives()) return failed(name, "remove");
    m_files.erase(name);
    return Done{};
}

void MemoryStore::crash(std::uint64_t seed) {
    revive();
    std::uint64_t state = seed;
    for (auto& [name, file] : m_files) {
        const std::size_t loose = file.data.size() - file.synced;
        file.data.resize(file.synced + static_cast<std::size_t>(nextRandom(state) % (loose + 1)));
        for (std::size_t at = file.synced; at < file.data.size();) {
            const std::size_t end = std::min(file.data.size(), (at / sector + 1) * sector);
            if (nextRandom(state) % 4 == 0) {
                std::fill(file.data.begin() + static_cast<std::ptrdiff_t>(at),
                          file.data.begin() + static_cast<std::ptrdiff_t>(end), std::byte{0});
            }
            at = end;
        }
        file.synced = file.data.size();
    }
}

}  // namespace huestep::protocol
