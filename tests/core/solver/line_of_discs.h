/// Discs on a line, and what a soft step does to them, worked out in double without any of the
/// solver's code: with its normals along the line a contact is one row and a body one number.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "core/solver/effort.h"
#include "tests/core/support.h"

namespace huestep::test {

/// Discs of radius 0.5 m along x, without gravity, friction or bounce.
struct LineOfDiscs {
    std::vector<double> mass;      // kg
    std::vector<double> position;  // m
    std::vector<double> velocity;  // m/s

    [[nodiscard]] std::size_t size() const { return mass.size(); }
    [[nodiscard]] double gap(std::size_t i) const { return position[i + 1] - position[i] - 1.0; }
    [[nodiscard]] double momentum() const {
        double sum = 0.0;
        for (std::size_t i = 0; i < size(); ++i) sum += mass[i] * velocity[i];
        return sum;
    }
};

/// The scene, its bodies listed in the order given; body ids are place + 1.
inline Scene sceneOf(const LineOfDiscs& line, const std::vector<std::uint32_t>& order) {
    Scene scene;
    scene.gravity = {};
    scene.sleep = false;
    for (const std::uint32_t i : order) {
        BodyDef disc = discAt({static_cast<float>(line.position[i]), 0.0f});
        disc.shapes[0].density = static_cast<float>(line.mass[i] / (M_PI * 0.25));
        disc.shapes[0].material.friction = 0.0f;
        disc.velocity = {static_cast<float>(line.velocity[i]), 0.0f};
        scene.bodies.push_back(disc);
    }
    return scene;
}
inline Scene sceneOf(const LineOfDiscs& line) {
    std::vector<std::uint32_t> order;
    for (std::uint32_t i = 0; i < line.size(); ++i) order.push_back(i);
    return sceneOf(line, order);
}

/// Touching discs of 1 to 4 kg that come together from both ends: every contact has work to do.
inline LineOfDiscs randomLine(Random& random, std::size_t count) {
    LineOfDiscs line;
    for (std::size_t i = 0; i < count; ++i) {
        const double middle = 0.5 * static_cast<double>(count - 1);
        line.mass.push_back(random.between(1.0, 4.0));
        line.position.push_back(static_cast<double>(i) * 0.999);
        line.velocity.push_back((middle - static_cast<double>(i)) * random.between(0.2, 0.4));
    }
    return line;
}

enum class Order { OneByOne, SideBySide, Split };

/// The soft step of the physics page on a line: n substeps of warm start, biased sweep, motion and
/// relaxing sweep, as in the first step of a world. `Split`: every body divided among its contacts.
inline void softStepOf(LineOfDiscs& line, int substeps, Order order) {
    const double h = 1.0 / 60.0 / substeps;
    const double frequency = wide(rowFrequency(static_cast<std::uint32_t>(substeps)).contact);
    const double omega = 2.0 * M_PI * frequency / h, damping = 10.0;
    const double a1 = 2.0 * damping + h * omega, a2 = h * omega * a1, a3 = 1.0 / (1.0 + a2);
    const std::size_t contacts = line.size() - 1;
    std::vector<double> impulse(contacts, 0.0);
    const auto shares = [&](std::size_t body) {
        if (order != Order::Split) return 1.0;
        return body == 0 || body == contacts ? 1.0 : 2.0;
    };
    const auto sweep = [&](bool bias) {
        std::vector<double> frozen = line.velocity;
        for (std::size_t i = 0; i < contacts; ++i) {
            const std::vector<double>& v = order == Order::OneByOne ? line.velocity : frozen;
            const double mass = 1.0 / (shares(i) / line.mass[i] + shares(i + 1) / line.mass[i + 1]);
            const double gap = line.gap(i), speed = v[i + 1] - v[i];
            double change = 0.0;
            if (gap > 0.0) {
                change = -mass * (speed + gap / h);
            } else if (bias) {
                const double push = std::max(gap * omega / a1, -3.0);
                change = -mass * a2 * a3 * (speed + push) - a3 * impulse[i];
            } else {
                change = -mass * speed;
            }
            change = std::max(impulse[i] + change, 0.0) - impulse[i];
            impulse[i] += change;
            line.velocity[i] -= change / line.mass[i];
            line.velocity[i + 1] += change / line.mass[i + 1];
        }
    };
    for (int substep = 0; substep < substeps; ++substep) {
        for (std::size_t i = 0; i < contacts; ++i) {
            line.velocity[i] -= impulse[i] / line.mass[i];
            line.velocity[i + 1] += impulse[i] / line.mass[i + 1];
        }
        sweep(true);
        for (std::size_t i = 0; i < line.size(); ++i) line.position[i] += h * line.velocity[i];
        sweep(false);
        // Contacts that have begun get three more.
        for (int k = 0; substep == 0 && k < 3; ++k) sweep(false);
    }
}

/// The largest difference of velocities, m/s.
inline double distanceOf(const World& world, const LineOfDiscs& line) {
    double most = 0.0;
    for (std::size_t i = 0; i < line.size(); ++i) {
        const BodyMotion m = world.motions()[i];
        most = std::max(most, std::abs(wide(m.velocity.x) - line.velocity[i]));
    }
    return most;
}

/// Solves a x = b by elimination with pivots; none where it is singular.
inline std::optional<std::vector<double>> solved(std::vector<std::vector<double>> a,
                                                 std::vector<double> b) {
    const std::size_t n = b.size();
    for (std::size_t k = 0; k < n; ++k) {
        std::size_t pivot = k;
        for (std::size_t i = k; i < n; ++i) {
            if (std::abs(a[i][k]) > std::abs(a[pivot][k])) pivot = i;
        }
        if (std::abs(a[pivot][k]) < 1e-12) return std::nullopt;
        std::swap(a[k], a[pivot]);
        std::swap(b[k], b[pivot]);
        for (std::size_t i = 0; i < n; ++i) {
            if (i == k) continue;
            const double f = a[i][k] / a[k][k];
            for (std::size_t j = k; j < n; ++j) a[i][j] -= f * a[k][j];
            b[i] -= f * b[k];
        }
    }
    for (std::size_t k = 0; k < n; ++k) b[k] /= a[k][k];
    return b;
}

/// Velocities after a step of rigid rows: λ ≥ 0, w = A λ + b ≥ 0, λ·w = 0, found by trying every
/// set of rows that push. `bias(gap)`: the speed at which a gap may close, or must open if > 0.
template <class Bias>
std::vector<double> exactVelocities(const LineOfDiscs& line, Bias&& bias) {
    const std::size_t rows = line.size() - 1;
    std::vector<std::vector<double>> a(rows, std::vector<double>(rows, 0.0));
    std::vector<double> b(rows);
    for (std::size_t i = 0; i < rows; ++i) {
        a[i][i] = 1.0 / line.mass[i] + 1.0 / line.mass[i + 1];
        if (i + 1 < rows) a[i][i + 1] = a[i + 1][i] = -1.0 / line.mass[i + 1];
        b[i] = line.velocity[i + 1] - line.velocity[i] - bias(line.gap(i));
    }
    for (std::uint32_t set = 0; set < (1u << rows); ++set) {
        std::vector<std::size_t> pushing;
        for (std::size_t i = 0; i < rows; ++i) {
            if ((set >> i & 1u) != 0) pushing.push_back(i);
        }
        std::vector<std::vector<double>> part;
        std::vector<double> rhs;
        for (const std::size_t i : pushing) {
            part.emplace_back();
            for (const std::size_t j : pushing) part.back().push_back(a[i][j]);
            rhs.push_back(-b[i]);
        }
        const auto found = solved(part, rhs);
        if (!found) continue;
        std::vector<double> impulse(rows, 0.0);
        for (std::size_t k = 0; k < pushing.size(); ++k) impulse[pushing[k]] = (*found)[k];
        bool fits = true;
        for (std::size_t i = 0; i < rows; ++i) {
            double w = b[i];
            for (std::size_t j = 0; j < rows; ++j) w += a[i][j] * impulse[j];
            fits = fits && impulse[i] > -1e-9 && w > -1e-9;
        }
        if (!fits) continue;
        std::vector<double> v = line.velocity;
        for (std::size_t i = 0; i < rows; ++i) {
            v[i] -= impulse[i] / line.mass[i];
            v[i + 1] += impulse[i] / line.mass[i + 1];
        }
        return v;
    }
    ADD_FAILURE() << "every such problem has a solution";
    return line.velocity;
}

/// Some discs overlap, some have a gap, some come together, some part.
inline LineOfDiscs mixedLine(Random& random) {
    LineOfDiscs line;
    double x = 0.0;
    for (int i = 0; i < 7; ++i) {
        line.mass.push_back(random.between(1.0, 4.0));
        line.position.push_back(x);
        line.velocity.push_back(random.between(-1.0, 1.0));
        x += 1.0 + random.between(-0.03, 0.015);
    }
    return line;
}

}  // namespace huestep::test
