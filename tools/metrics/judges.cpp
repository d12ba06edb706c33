#include "tools/metrics/judges.h"

#include <algorithm>
#include <cmath>

namespace huestep::tools {
namespace {

bool isWhole(const BodyMotion& m) {
    return std::isfinite(m.position.x) && std::isfinite(m.position.y) &&
           std::isfinite(m.rotation.c) && std::isfinite(m.rotation.s) &&
           std::isfinite(m.velocity.x) && std::isfinite(m.velocity.y) &&
           std::isfinite(m.angularVelocity);
}

class Folded final : public Judge {
 public:
    Folded(const World& start, Fold fold, Window window, Measure measure)
        : m_bodies(start.motions().size()),
          m_step(static_cast<double>(start.info().stepSeconds)),
          m_window(window),
          m_measure(std::move(measure)),
          m_sizes(fold) {}

    void watch(std::uint64_t tick, std::span<const Command>, std::span<const BodyMotion> motions,
               bool) override {
        if (tick < m_window.first || tick > m_window.last) return;
        // Not left to the measure: a maximum may pass over what is no number.
        const bool whole =
            motions.size() == m_bodies && std::all_of(motions.begin(), motions.end(), isWhole);
        const double value =
            whole ? m_measure({tick, static_cast<double>(tick) * m_step, motions}) : failed;
        m_sizes.add(std::abs(value));
    }

    [[nodiscard]] double error() const override { return m_sizes.value(); }

 private:
    std::size_t m_bodies;
    double m_step;  // s
    Window m_window;
    Measure m_measure;
    Folding m_sizes;
};

}  // namespace

std::unique_ptr<Judge> folded(const World& start, Fold fold, Window window, Measure measure) {
    return std::make_unique<Folded>(start, fold, window, std::move(measure));
}

Start::Start(const World& world)
    : info(world.info()),
      bodies(world.bodies().begin(), world.bodies().end()),
      shapes(world.shapes().begin(), world.shapes().end()),
      joints(world.joints().begin(), world.joints().end()),
      motions(world.motions().begin(), world.motions().end()) {}

Measures Start::measured(std::span<const BodyMotion> now) const {
    return measure(info, bodies, shapes, joints, now);
}

double Start::kinetic(std::span<const BodyMotion> now) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        if (bodies[i].dynamic()) sum += kineticEnergy(bodies[i], now[i]);
    }
    return sum;
}

}  // namespace huestep::tools
