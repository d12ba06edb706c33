/// A touching contact: its state, and what is derived from it.
#pragma once

#include <cstdint>

#include "core/collision/manifold.h"
#include "core/contact/contact_fields.h"
#include "core/state/records.h"

namespace huestep {

/// Speculative margin: points up to this far apart are contact points. See physics page.
inline constexpr float speculativeDistance = 0.02f;  // m

/// A touching pair of shapes. What `stateOf` reads is state; all else is an accelerator. While the
/// solver holds the contact's row, the impulses in there are the current ones.
struct alignas(64) Contact {
    std::uint32_t bodyA = 0;  ///< places in the world's arrays
    std::uint32_t bodyB = 0;
    std::uint32_t placeA = 0;  ///< of the shapes, the one with the lower id first
    std::uint32_t placeB = 0;
    float inverseMassA = 0, inverseMassB = 0;  ///< 1/kg
    float turn = 0;  ///< body A's rotation when the manifold was made, see `turnOf`
    std::uint16_t feature[2]{};
    std::uint8_t pointCount = 0;  ///< 0: not touching any more
    std::uint8_t began = 0;       ///< 1: in this very step

    // The manifold, turned into the world as body A was when it was made, and the impulses.
    ContactFields<float> row{};
    ContactPointFields<float> points[2]{};

    [[nodiscard]] Vec2 normal() const { return {row.normalX, row.normalY}; }
    [[nodiscard]] Rotation rotationA() const { return {row.cosineA, row.sineA}; }
    [[nodiscard]] Rotation rotationB() const { return {row.cosineB, row.sineB}; }
    [[nodiscard]] Vec2 anchorA(std::size_t point) const {
        return {points[point].anchorAx, points[point].anchorAy};
    }
    [[nodiscard]] Vec2 anchorB(std::size_t point) const {
        return {points[point].anchorBx, points[point].anchorBy};
    }
    /// Body B's centre frame seen from body A's when the manifold was made.
    [[nodiscard]] Pose relative() const {
        return {{row.relativeX, row.relativeY}, {row.relativeC, row.relativeS}};
    }
};

static_assert(sizeof(Contact) == 192, "three cache lines");

/// Brings a contact nearer that is read soon.
inline void prefetch(const Contact& contact) {
    const char* from = reinterpret_cast<const char*>(&contact);
    for (std::size_t line = 0; line < sizeof(Contact); line += 64) __builtin_prefetch(from + line);
}

/// The effective masses of a point's two rows: 1/(m⁻¹ + I⁻¹ (r × d)²), d the row's direction.
struct RowMasses {
    float normal = 0;   ///< kg
    float tangent = 0;  ///< kg
};

/// `mass`: the sum of both bodies' inverse masses, 1/kg; inertias inverse too, 1/(kg·m²).
inline RowMasses rowMasses(Vec2 rA, Vec2 rB, Vec2 normal, float mass, float inertiaA,
                           float inertiaB) {
    const float rnA = cross(rA, normal), rnB = cross(rB, normal);
    const float rtA = dot(rA, normal), rtB = dot(rB, normal);  // r × t = −r·n for t = (ny, −nx)
    return {inverseOrZero(mass + inertiaA * rnA * rnA + inertiaB * rnB * rnB),
            inverseOrZero(mass + inertiaA * rtA * rtA + inertiaB * rtB * rtB)};
}

/// The impulses of a contact as the next step starts from them.
struct ContactImpulses {
    std::array<float, 2> normal{};   ///< N·s, ≥ 0
    std::array<float, 2> tangent{};  ///< N·s
    float rolling = 0;               ///< N·m·s
};

inline ContactImpulses impulsesOf(const Contact& contact) {
    return {{contact.points[0].normalImpulse, contact.points[1].normalImpulse},
            {contact.points[0].tangentImpulse, contact.points[1].tangentImpulse},
            contact.row.rollingImpulse};
}

inline void setImpulses(Contact& contact, const ContactImpulses& impulses) {
    for (std::size_t i = 0; i < 2; ++i) {
        contact.points[i].normalImpulse = impulses.normal[i];
        contact.points[i].tangentImpulse = impulses.tangent[i];
    }
    contact.row.rollingImpulse = impulses.rolling;
}

/// The contact as state, with the ids of its shapes and the impulses given: its own, or those of
/// the solver's row.
inline ContactState stateOf(const Contact& contact, ShapeId shapeA, ShapeId shapeB,
                            const ContactImpulses& impulses) {
    return {shapeA,          shapeB,           contact.relative(), contact.turn,
            impulses.normal, impulses.tangent, impulses.rolling};
}

}  // namespace huestep
