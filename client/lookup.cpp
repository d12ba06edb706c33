#include "client/lookup.h"

#include <netdb.h>

#include <cerrno>
#include <cstring>
#include <mutex>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

namespace huestep::client {

Result<SocketAddresses> askSystem(const protocol::Address& address) {
    addrinfo hints{};
    hints.ai_socktype = SOCK_STREAM;
    addrinfo* list = nullptr;
    const std::string port = std::to_string(address.port);
    const int status = ::getaddrinfo(address.host.c_str(), port.c_str(), &hints, &list);
    if (status == EAI_SYSTEM) return Error{std::strerror(errno)};
    if (status != 0) return Error{::gai_strerror(status)};
    const std::unique_ptr<addrinfo, void (*)(addrinfo*)> owned(list, ::freeaddrinfo);
    SocketAddresses out;
    for (const addrinfo* each = list; each; each = each->ai_next) {
        if (each->ai_addrlen > sizeof(sockaddr_storage)) continue;
        std::memcpy(&out.emplace_back(), each->ai_addr, each->ai_addrlen);
    }
    if (out.empty()) return Error{"the name has no address"};
    return out;
}

struct Lookup::Shared {
    std::mutex mutex;
    std::function<void()> done;  ///< empty: nobody waits any more
    std::optional<Result<SocketAddresses>> found;
};

Lookup::Lookup(Resolve resolve, protocol::Address address, std::function<void()> done)
    : m_shared(std::make_shared<Shared>()) {
    m_shared->done = std::move(done);
    const auto tell = [shared = m_shared](Result<SocketAddresses> found) {
        const std::lock_guard lock(shared->mutex);
        shared->found = std::move(found);
        if (shared->done) shared->done();
    };
    try {
        std::thread([tell, resolve = std::move(resolve), address = std::move(address)] {
            tell(resolve(address));
        }).detach();
    } catch (const std::system_error& noThread) {
        tell(Error{std::string("no thread to look the name up: ") + noThread.what()});
    }
}

Lookup::~Lookup() {
    const std::lock_guard lock(m_shared->mutex);
    m_shared->done = nullptr;
}

std::optional<Result<SocketAddresses>> Lookup::take() {
    const std::lock_guard lock(m_shared->mutex);
    return std::exchange(m_shared->found, std::nullopt);
}

}  // namespace huestep::client
