/// Bodies that hang from each other by hinges, by their equations of motion in minimal coordinates:
/// the angles of the bodies, so that no joint can be off. In double, by the classical Runge-Kutta
/// method; shares nothing with the product's solver.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/world/world.h"

namespace huestep::reference {

using Vec2d = Vec2T<double>;

/// A tree of bodies on plain revolute joints. Contacts are not seen. Thread rule: a plain value.
class Linkage {
 public:
    /// None where a joint is no plain hinge, a dynamic body is damped or cannot turn, or where it
    /// does not hang, directly or over others, from one that is static, by exactly one joint.
    static std::optional<Linkage> find(const World& start);

    /// Goes on for `seconds` in `steps` equal steps.
    void advance(double seconds, int steps);

    /// m, of the centre of mass of the body at this place in the world; static ones too.
    [[nodiscard]] Vec2d position(std::size_t place) const;
    [[nodiscard]] double angle(std::size_t place) const;  ///< rad
    [[nodiscard]] double energy() const;                  ///< J: Σ m v²/2 + I ω²/2 − m g·x
    /// m, between the centres of the same body here and there, of the body that is farthest.
    [[nodiscard]] double distanceTo(const Linkage& other) const;

 private:
    static constexpr std::size_t none = ~std::size_t{0};
    struct Link {
        std::size_t place = 0;      // in the world
        std::size_t parent = none;  // link; none: fixed
        Vec2d hook;                 // m: joint from the parent's centre, in its frame; in the world
        Vec2d arm;                  // m: joint from the own centre, in the own frame
        double mass = 0.0;
        double inertia = 0.0;
        Vec2d weight;  // N
    };
    struct State {
        std::vector<double> angle;  // rad, of each link
        std::vector<double> rate;   // rad/s
    };
    bool hang(const World& start, const JointInfo& joint, std::size_t above, std::size_t below);
    [[nodiscard]] std::vector<Vec2d> centers(const std::vector<double>& angle) const;
    [[nodiscard]] std::vector<double> accelerations(const State& at) const;

    std::vector<Link> m_links;          // parents first
    std::vector<std::size_t> m_linkOf;  // by place in the world
    std::vector<Vec2d> m_fixed;         // m, by place in the world: where it starts
    State m_state;
};

/// Where a linkage is after some time, and how far halving the last step moved any of its bodies.
struct LinkageSolution {
    Linkage linkage;
    double change = 0.0;  ///< m
    int steps = 0;
};

/// Halves the step until that changes no position by more than `tolerance` m, or rounding wins: at
/// most 2²⁰ steps.
LinkageSolution solveLinkage(const Linkage& start, double seconds, double tolerance = 1e-12);

}  // namespace huestep::reference
