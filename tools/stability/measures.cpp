#include "tools/stability/measures.h"

#include <algorithm>
#include <cmath>

#include "core/math/trig.h"
#include "core/scene/in_double.h"
#include "core/scene/measure.h"

namespace huestep::tools::stability {

namespace {

/// The largest of `f(body)` over the dynamic bodies; `none` if there are none.
template <class F>
double mostOf(const Moment& moment, double none, const F& f) {
    double most = none;
    for (const Tracked& body : moment.bodies)
        if (body.dynamic) most = std::max(most, f(body));
    return most;
}

double turnedOf(const Tracked& body) {
    return std::abs(angleOf(relative(body.start.q, body.now.q)));
}

double movedOf(const Tracked& body) {
    return length(body.now.p - body.start.p);
}

template <class Holds>
double countOf(const Moment& moment, const Holds& holds) {
    const auto count = std::count_if(moment.bodies.begin(), moment.bodies.end(),
                                     [&](const Tracked& b) { return b.dynamic && holds(b); });
    return static_cast<double>(count);
}

double kineticOf(const Tracked& body, Vec2d velocity, double spin) {
    return 0.5 * body.mass * lengthSquared(velocity) + 0.5 * body.inertia * spin * spin;
}

/// Of the one body that moves.
const Tracked& theBody(const Moment& moment) {
    return *std::find_if(moment.bodies.begin(), moment.bodies.end(),
                         [](const Tracked& body) { return body.dynamic; });
}

const Tracked& bodyOf(const Moment& moment, BodyId id) {
    return *std::find_if(moment.bodies.begin(), moment.bodies.end(),
                         [id](const Tracked& body) { return body.id == id; });
}

double outsideOf(Vec2d p, double half) {
    return std::max(std::abs(p.x), std::abs(p.y)) - half;
}

}  // namespace

double farthestMoved(const Moment& moment) {
    return mostOf(moment, 0.0, movedOf);
}

double farthestAside(const Moment& moment) {
    return mostOf(moment, 0.0, [](const Tracked& b) { return std::abs(b.now.p.x - b.start.p.x); });
}

double furthestTurned(const Moment& moment) {
    return mostOf(moment, 0.0, turnedOf);
}

double fastest(const Moment& moment) {
    return mostOf(moment, 0.0, [](const Tracked& body) { return length(body.velocity); });
}

double rmsSpeed(const Moment& moment) {
    double sum = 0.0;
    double bodies = 0.0;
    for (const Tracked& body : moment.bodies) {
        if (!body.dynamic) continue;
        sum += lengthSquared(body.velocity);
        bodies += 1.0;
    }
    return bodies > 0.0 ? std::sqrt(sum / bodies) : 0.0;
}

double lowest(const Moment& moment) {
    return mostOf(moment, -std::numeric_limits<double>::infinity(),
                  [](const Tracked& body) { return -body.now.p.y; });
}

double energyGain(const Moment& moment) {
    return moment.energyGain;
}

double penetration(const Moment& moment) {
    const Definitions& d = *moment.definitions;
    return measure(d.info(), d.bodies(), d.shapes(), d.joints(), moment.motions).maxPenetration;
}

double jointError(const Moment& moment) {
    const Definitions& d = *moment.definitions;
    return maxJointErrorOf(d.bodies(), d.joints(), moment.motions);
}

Measure fallen(double metres, double radians) {
    return [=](const Moment& moment) {
        return countOf(moment, [&](const Tracked& body) {
            return movedOf(body) >= metres || turnedOf(body) >= radians;
        });
    };
}

Measure standing(double radians) {
    return [=](const Moment& moment) {
        return countOf(moment, [&](const Tracked& body) { return turnedOf(body) < radians; });
    };
}

Measure movedFromRest(std::function<double(const Tracked& body)> drop) {
    return [drop = std::move(drop)](const Moment& moment) {
        return mostOf(moment, 0.0, [&](const Tracked& body) {
            return length(body.now.p - (body.start.p - Vec2d{0.0, drop(body)}));
        });
    };
}

double armError(const Moment& moment) {
    const Tracked& body = theBody(moment);
    const double start = length(body.start.p);
    return std::abs(length(body.now.p) - start) / start;
}

double kineticLoss(const Moment& moment) {
    const Tracked& body = theBody(moment);
    const double start = kineticOf(body, body.startVelocity, body.startSpin);
    return (start - kineticOf(body, body.velocity, body.spin)) / start;
}

Measure beyond(double x) {
    return [x](const Moment& moment) {
        double most = -std::numeric_limits<double>::infinity();
        for (const ShapeInfo& shape : moment.definitions->shapes()) {
            const Tracked& body = bodyOf(moment, shape.body);
            if (!body.dynamic) continue;
            for (int i = 0; i < shape.vertexCount(); ++i) {
                const Vec2 vertex = shape.vertices[static_cast<std::size_t>(i)];
                const double front = transform(body.now, inDouble(vertex)).x;
                most = std::max(most, front + static_cast<double>(shape.radius) - x);
            }
        }
        return most;
    };
}

Measure outside(double half) {
    return [half](const Moment& moment) {
        return mostOf(moment, -half,
                      [&](const Tracked& body) { return outsideOf(body.now.p, half); });
    };
}

Measure outsideDrum(BodyId drum, double half) {
    return [=](const Moment& moment) {
        const Posed frame = bodyOf(moment, drum).now;
        return mostOf(moment, -half, [&](const Tracked& body) {
            return body.id == drum ? -half : outsideOf(untransform(frame, body.now.p), half);
        });
    };
}

Measure kineticShare(BodyId drum, double height) {
    return [=](const Moment& moment) {
        const double gravity = length(inDouble(moment.definitions->info().gravity));
        double kinetic = 0.0;
        double weight = 0.0;
        for (const Tracked& body : moment.bodies) {
            if (!body.dynamic || body.id == drum) continue;
            kinetic += kineticOf(body, body.velocity, body.spin);
            weight += body.mass * gravity;
        }
        return weight > 0.0 ? kinetic / (weight * height) : 0.0;
    };
}

double hubResidual(const Moment& moment) {
    const Tracked& hub = bodyOf(moment, 1);
    const auto radiusOf = [&](std::size_t place) {
        return static_cast<double>(moment.definitions->shapes()[place].radius);
    };
    const double substep = 1.0 / 240.0;  // s
    double sum = 0.0;
    for (std::size_t i = 1; i < moment.bodies.size(); ++i) {
        const Tracked& disc = moment.bodies[i];
        const Vec2d d = disc.now.p - hub.now.p;
        const double distance = length(d);
        const double gap = distance - radiusOf(0) - radiusOf(i);
        const double approach = -dot(disc.velocity - hub.velocity, (1.0 / distance) * d);
        double wrong = std::max(-gap, 0.0);
        if (gap < 0.005) wrong += std::max(approach, 0.0) * substep;
        sum += wrong * wrong;
    }
    return std::sqrt(sum / static_cast<double>(moment.bodies.size() - 1));
}

}  // namespace huestep::tools::stability
