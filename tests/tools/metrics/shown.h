/// Judges of metrics, shown made-up motions instead of runs.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "tools/metrics/metric.h"

namespace huestep::tools {

using Motions = std::vector<BodyMotion>;

inline float f(double x) {
    return static_cast<float>(x);
}

/// The judge of a case, and the motions that it is shown.
class Shown {
 public:
    explicit Shown(const char* name) : m_metric(findMetricCase(name)) {
        EXPECT_NE(m_metric, nullptr) << name;
        Scene scene = m_metric->scene();
        scene.substeps = 4;
        Result<World> world = World::create(scene);
        EXPECT_TRUE(world.ok());
        m_start.assign(world->motions().begin(), world->motions().end());
        m_judge = m_metric->judge(*world);
    }
    [[nodiscard]] const Motions& start() const { return m_start; }

    /// Shows every tick of the case; `move` takes bodies from where they start to where they are at
    /// `t` seconds.
    double error(const std::function<void(double t, Motions& motions)>& move) {
        for (std::uint64_t tick = 1; tick <= m_metric->ticks; ++tick) {
            Motions now = m_start;
            move(static_cast<double>(tick) / 60.0, now);
            m_judge->watch(tick, {}, now, false);
        }
        return m_judge->error();
    }

 private:
    const MetricCase* m_metric;
    Motions m_start;
    std::unique_ptr<Judge> m_judge;
};

/// An engine that plays what it is told, for metrics that take several runs.
class Player final : public Engine {
 public:
    using Move = std::function<void(double t, Motions& motions)>;
    Player(const Scene& scene, Move move) : m_move(std::move(move)) {
        const Result<World> world = World::create(scene);
        EXPECT_TRUE(world.ok());
        m_start.assign(world->motions().begin(), world->motions().end());
    }
    Status step(std::span<const Command>) override {
        ++m_ticks;
        return Done{};
    }
    [[nodiscard]] std::vector<BodyMotion> motions() const override {
        Motions now = m_start;
        m_move(static_cast<double>(m_ticks) / 60.0, now);
        return now;
    }
    [[nodiscard]] std::uint64_t hash() const override { return 0; }
    [[nodiscard]] std::uint32_t contactCount() const override { return 0; }
    [[nodiscard]] std::string_view name() const override { return "player"; }

 private:
    Motions m_start;
    Move m_move;
    std::uint64_t m_ticks = 0;
};

/// A world as an engine, on one thread.
class Stepper final : public Engine {
 public:
    explicit Stepper(World world) : m_world(std::move(world)) {}
    Status step(std::span<const Command> commands) override {
        m_world.step(commands);
        return Done{};
    }
    [[nodiscard]] std::vector<BodyMotion> motions() const override {
        return {m_world.motions().begin(), m_world.motions().end()};
    }
    [[nodiscard]] std::uint64_t hash() const override { return m_world.motionRoot(); }
    [[nodiscard]] std::uint32_t contactCount() const override { return m_world.report().contacts; }
    [[nodiscard]] std::string_view name() const override { return "huestep"; }

 private:
    World m_world;
};

/// What a series says of players; `play` gives the motion of a scene's player.
inline double errorOfPlayers(const char* name, std::uint32_t substeps,
                             const std::function<Player::Move(const Scene&)>& play) {
    Setting setting;
    setting.substeps = substeps;
    setting.method = Method::SoftStep;
    setting.make = [play](const Scene& scene) -> Result<std::unique_ptr<Engine>> {
        return std::unique_ptr<Engine>(std::make_unique<Player>(scene, play(scene)));
    };
    const Result<double> error = errorOf(*findMetricCase(name), setting);
    EXPECT_TRUE(error.ok());
    return error.ok() ? *error : -1.0;
}

}  // namespace huestep::tools
