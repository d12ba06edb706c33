/// Whether the other side still lives, counted in beats of a timer.
#pragma once

namespace huestep::client {

/// A silent server and a broken line look alike: nothing comes. After some beats without a byte
/// the server is to be asked with a Ping, which every server answers at once; after more of them
/// the connection is given up.
///
/// Beats are counted, not time: a process that was stopped, or that computed for long, misses
/// beats as well, and does not take its own absence for the server's silence.
class Pulse {
 public:
    static constexpr int askAfter = 4;      ///< beats, and again after as many more
    static constexpr int silentAfter = 20;  ///< beats

    enum class Beat { Quiet, Ask, Silent };

    /// Bytes came, whatever they say.
    void heard() { m_missed = 0; }

    /// Once a beat: what to do.
    Beat beat() {
        if (++m_missed >= silentAfter) return Beat::Silent;
        return m_missed % askAfter == 0 ? Beat::Ask : Beat::Quiet;
    }

 private:
    int m_missed = 0;  ///< beats since bytes came
};

}  // namespace huestep::client
