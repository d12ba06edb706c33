/// A server as a process, and what its output says.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tests/tools/process.h"

namespace huestep::test {

/// `huestep serve` with one session, on loopback; port 0 or the address of an earlier one.
class Server {
 public:
    Server(const std::string& data, const std::string& session, const std::string& address,
           const std::vector<std::string>& more = {})
        : m_process(words(data, session, address, more)) {}

    /// Where it listens; empty if it does not say so in time.
    [[nodiscard]] std::string address() const {
        const std::string word = "listening on ";
        Process::until(30.0, [&] {
            const std::string out = m_process.out();
            return out.find(word) != std::string::npos && out.back() == '\n';
        });
        return after(m_process.out(), word);
    }

    /// Waits until the log shows so many welcomes.
    [[nodiscard]] bool welcomes(int count, double seconds) const {
        return Process::until(seconds,
                              [&] { return linesWith(m_process.err(), "event=welcome") >= count; });
    }

    [[nodiscard]] Process& process() { return m_process; }

 private:
    static std::vector<std::string> words(const std::string& data, const std::string& session,
                                          const std::string& address,
                                          const std::vector<std::string>& more) {
        std::vector<std::string> out = {huestepProgram, "serve",     "--listen", address, "--data",
                                        data,           "--session", session,    "--open"};
        out.insert(out.end(), more.begin(), more.end());
        return out;
    }

    Process m_process;
};

inline std::unique_ptr<Process> join(const std::string& address, const std::string& session,
                                     std::vector<std::string> more = {}) {
    std::vector<std::string> words = {huestepProgram, "join",  address,
                                      "--session",    session, "--json"};
    words.insert(words.end(), more.begin(), more.end());
    return std::make_unique<Process>(std::move(words));
}

}  // namespace huestep::test
