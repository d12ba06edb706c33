/// Programs as a user's shell runs them: arguments in; exit status, output and errors out. Every
/// wait is bounded, and whatever is still running when its `Process` goes is killed by its id.
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

namespace huestep::test {

inline std::string textOf(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

/// A folder of its own that goes with it.
class TemporaryFolder {
 public:
    TemporaryFolder() {
        std::string pattern = (std::filesystem::temp_directory_path() / "huestep-XXXXXX").string();
        if (::mkdtemp(pattern.data()) != nullptr) m_path = pattern;
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        if (!m_path.empty()) std::filesystem::remove_all(m_path, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    [[nodiscard]] std::string operator/(const std::string& name) const {
        return (m_path / name).string();
    }

 private:
    std::filesystem::path m_path;
};

class Process {
 public:
    /// Starts a program with its output in files of a folder of its own.
    explicit Process(std::vector<std::string> words) {
        std::vector<char*> argv;
        for (std::string& word : words) argv.push_back(word.data());
        argv.push_back(nullptr);
        const std::string out = m_folder / "out";
        const std::string err = m_folder / "err";
        m_pid = ::fork();
        if (m_pid != 0) return;
        const int mode = O_CREAT | O_WRONLY | O_TRUNC;
        ::dup2(::open("/dev/null", O_RDONLY), STDIN_FILENO);
        ::dup2(::open(out.c_str(), mode, 0600), STDOUT_FILENO);
        ::dup2(::open(err.c_str(), mode, 0600), STDERR_FILENO);
        ::execv(argv[0], argv.data());
        ::_exit(127);
    }
    ~Process() {
        if (m_status || m_pid <= 0) return;
        ::kill(m_pid, SIGKILL);
        ::waitpid(m_pid, nullptr, 0);
    }
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;

    void send(int signal) const {
        if (!m_status && m_pid > 0) ::kill(m_pid, signal);
    }

    /// Waits until the program has a handler of its own for a signal, as /proc shows it.
    [[nodiscard]] bool catches(int signal, double seconds) const {
        const std::string status = "/proc/" + std::to_string(m_pid) + "/status";
        return until(seconds, [&] {
            std::istringstream lines(textOf(status));
            for (std::string line; std::getline(lines, line);) {
                if (!line.starts_with("SigCgt:")) continue;
                const std::uint64_t caught = std::strtoull(line.c_str() + 7, nullptr, 16);
                return ((caught >> (signal - 1)) & 1) != 0;
            }
            return false;
        });
    }

    [[nodiscard]] std::string out() const { return textOf(m_folder / "out"); }
    [[nodiscard]] std::string err() const { return textOf(m_folder / "err"); }

    /// Exit status, or 128 + signal as a shell says it; none: still running after the time.
    std::optional<int> wait(double seconds) {
        until(seconds, [this] {
            int status = 0;
            if (!m_status && ::waitpid(m_pid, &status, WNOHANG) == m_pid)
                m_status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
            return m_status.has_value();
        });
        return m_status;
    }

    /// Asks `condition` until it holds or the time is over; says whether it held.
    template <class Condition>
    static bool until(double seconds, Condition condition) {
        const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
        while (!condition()) {
            if (std::chrono::steady_clock::now() > end) return false;
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        return true;
    }

 private:
    TemporaryFolder m_folder;
    pid_t m_pid = -1;
    std::optional<int> m_status;
};

struct Ended {
    int status = -1;  ///< −1: did not end in time
    std::string out;
    std::string err;
};

inline const std::string huestepProgram = std::string(HUESTEP_BINARY_DIR) + "/huestep";

/// Runs `huestep` with the words to its end, for at most two minutes.
inline Ended huestep(std::vector<std::string> words) {
    words.insert(words.begin(), huestepProgram);
    Process process(std::move(words));
    const std::optional<int> status = process.wait(120.0);
    return {status.value_or(-1), process.out(), process.err()};
}

/// How many lines of a text hold a word.
inline int linesWith(const std::string& text, const std::string& word) {
    std::istringstream lines(text);
    int count = 0;
    for (std::string line; std::getline(lines, line);)
        count += line.find(word) != std::string::npos ? 1 : 0;
    return count;
}

/// What follows a word on its line, up to the line's end; empty: no such line.
inline std::string after(const std::string& text, const std::string& word) {
    const std::size_t at = text.find(word);
    if (at == std::string::npos) return "";
    const std::size_t begin = at + word.size();
    return text.substr(begin, text.find('\n', begin) - begin);
}

}  // namespace huestep::test
