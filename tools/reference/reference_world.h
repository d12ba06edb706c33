/// A solver to judge others by: in double, with many substeps, contacts found anew in each of them
/// and Gauss-Seidel sweeps until nothing moves any more. Slow, plain, and apart from the product:
/// it shares definitions and the narrow phase in double, and no row, order, cache or constant.
///
/// Rigid: each substep is one of RATTLE (Andersen 1983), with inequalities and Coulomb's cone. Half
/// of gravity's push and the impulses that keep the constraints at the END of the substep's motion;
/// the motion; the other half and the impulses that keep their velocities. Second order where
/// motion is smooth, first order in the moment of an impact.
///
/// Soft: the soft step of the physics page, page "Starting point", with its two passes each swept
/// to the end: what the product would do if its rows were solved exactly and in double.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/collision/hull.h"
#include "core/result.h"
#include "core/world/world.h"

namespace huestep::reference {

using Vec2d = Vec2T<double>;

/// Soft rows: frequencies in Hz, damping ratios, and the speed at which overlaps are pushed out.
struct SoftRows {
    double contactHertz = 30.0;
    double groundHertz = 60.0;  ///< of contacts with what does not move
    double contactDamping = 10.0;
    double jointHertz = 60.0;
    double jointDamping = 1.0;
    double pushSpeed = 3.0;  ///< m/s

    /// Those that the product takes with the substeps of the world, which must be given.
    static SoftRows ofProduct(const WorldInfo& info);
};

struct Accuracy {
    int substeps = 64;             ///< of a tick
    std::optional<SoftRows> soft;  ///< none: rigid
    double residual = 1e-10;       ///< m/s, of any row after the last sweep
    int sweeps = 200'000;          ///< at most, a pass
};

struct Body {
    Vec2d position;  ///< m, of the centre of mass
    double angle = 0.0;
    Vec2d velocity;     ///< m/s
    double spin = 0.0;  ///< rad/s
    double inverseMass = 0.0;
    double inverseInertia = 0.0;
    Vec2d gravity;  ///< m/s²
};

class ReferenceWorld {
 public:
    /// Fails, with a sentence, where a scene has what this solver does not know: joints other than
    /// plain hinges, damping, rolling resistance, conveyors, chains, kinematic bodies that move.
    static Result<ReferenceWorld> create(const World& start, const Accuracy& accuracy);

    void step();  ///< one tick

    [[nodiscard]] std::span<const Body> bodies() const { return m_bodies; }  ///< as in the world
    /// The largest residual that any pass ended with so far, m/s.
    [[nodiscard]] double residual() const { return m_residual; }

 private:
    struct Shape {
        std::size_t body = 0;
        HullT<double> hull;
        double friction = 0.0;
        double restitution = 0.0;
        Filter filter;
    };
    struct Hinge {
        std::size_t a = 0, b = 0;
        Vec2d anchorA, anchorB;  // m, in the frames of the centres
        bool collides = false;
        // Of the pass:
        Vec2d rA, rB, error, impulse;
        double k11 = 0.0, k12 = 0.0, k22 = 0.0;
    };
    struct Point {
        std::size_t a = 0, b = 0;
        std::size_t shapeA = 0, shapeB = 0;
        std::uint16_t feature = 0;
        Vec2d normal;  // from A to B
        Vec2d rA, rB;
        double separation = 0.0;
        double friction = 0.0;
        double restitution = 0.0;
        double approach = 0.0;  // m/s, < 0: closing, before the substep
        bool ground = false;
        double normalMass = 0.0, tangentMass = 0.0;
        double normalImpulse = 0.0, tangentImpulse = 0.0;
    };
    /// How a pass ended: where the same pass of the next substep begins to sweep. Only a guess,
    /// from which the sweeps are soon done; they end where they would from nothing.
    struct Impulses {
        std::vector<Point> points;
        std::vector<Hinge> hinges;
    };
    /// What a pass asks of the rows: that v of a point be at least `target`, and softness.
    struct Soft {
        double biasRate = 0.0, massScale = 1.0, impulseScale = 0.0;
    };
    static Soft softnessOf(double hertz, double damping, double h);

    void collide();
    void addPoints(std::size_t a, std::size_t b);
    [[nodiscard]] bool linked(std::size_t a, std::size_t b) const;
    void prepareHinges();
    void guess(const Impulses& last);
    [[nodiscard]] Impulses impulses() const { return {m_points, m_hinges}; }
    void rigidSubstep(double h);
    void softSubstep(double h);
    void accelerate(double h);
    void move(double h);
    [[nodiscard]] Vec2d hingeError(const Hinge& hinge) const;
    [[nodiscard]] Vec2d relativeVelocity(const Point& p) const;
    void push(std::size_t a, std::size_t b, Vec2d rA, Vec2d rB, Vec2d impulse);
    double solveHinge(Hinge& hinge, Vec2d target, const Soft& soft);
    double solveNormal(Point& p, double target, const Soft& soft);
    double solveFriction(Point& p);
    template <class Pass>
    void sweep(Pass pass);

    double m_tick = 0.0;  // s
    Accuracy m_accuracy;
    std::vector<Body> m_bodies;
    std::vector<Shape> m_shapes;
    std::vector<Hinge> m_hinges;
    std::vector<Point> m_points;
    Impulses m_first, m_second;  // of the passes of the last substep
    double m_residual = 0.0;
};

/// Where all bodies are after each tick, the start first, and what speaks for it.
struct Trajectory {
    std::vector<std::vector<Body>> ticks;
    double uncertainty = 0.0;  ///< m, by which the farthest body moved when n was doubled
    double residual = 0.0;     ///< m/s, of the worst row at the end of any pass
};

/// Follows a scene with `accuracy`, and, unless its rows are soft, with twice the substeps, whose
/// trajectory it is: soft rows change with their substeps, so that there halving says nothing.
Result<Trajectory> follow(const World& start, std::uint64_t ticks, const Accuracy& accuracy);

}  // namespace huestep::reference
