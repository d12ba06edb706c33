// A19: the same scene elsewhere and turned; A20: orders of convergence.

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>

#include "core/math/trig.h"
#include "tools/metrics/case_lists.h"
#include "tools/metrics/judges.h"

namespace huestep::tools {
namespace {

/// Where a scene is put: turned about the origin, then moved.
struct Place {
    Rotation turn;
    Vec2 shift;
};

Scene movedTo(Scene scene, const Place& place) {
    const Pose pose{place.shift, place.turn};
    scene.gravity = rotate(place.turn, scene.gravity);
    for (BodyDef& body : scene.bodies) {
        body.position = transform(pose, body.position);
        body.rotation = compose(place.turn, body.rotation);
        body.velocity = rotate(place.turn, body.velocity);
    }
    return scene;
}

Result<std::unique_ptr<Engine>> engineOf(Scene scene, const Setting& setting) {
    if (setting.method) scene.method = *setting.method;
    if (setting.substeps != 0) scene.substeps = setting.substeps;
    return setting.make(scene);
}

/// How far two runs of the scene, here and there, are apart at most, seen from here.
Result<double> apart(const Scene& scene, const Place& place, std::uint64_t ticks,
                     const Setting& setting) {
    const Result<std::unique_ptr<Engine>> here = engineOf(scene, setting);
    if (!here) return here.error();
    const Result<std::unique_ptr<Engine>> there = engineOf(movedTo(scene, place), setting);
    if (!there) return there.error();
    const PoseT<double> pose{inDouble(place.shift), normalized(inDouble(place.turn))};
    double most = 0.0;
    for (std::uint64_t tick = 0; tick < ticks; ++tick) {
        for (Engine* engine : {here->get(), there->get()}) {
            if (const Status stepped = engine->step({}); !stepped) return stepped.error();
        }
        const std::vector<BodyMotion> a = (*here)->motions();
        const std::vector<BodyMotion> b = (*there)->motions();
        for (std::size_t i = 0; i < a.size(); ++i) {
            const double off =
                length(untransform(pose, inDouble(b[i].position)) - inDouble(a[i].position));
            most = std::isfinite(off) ? std::max(most, off) : failed;
        }
    }
    return most;
}

MetricCase frameCase(const std::string& of, SceneClass kind, const std::string& scene,
                     std::uint64_t ticks, const std::string& where, const Place& place) {
    MetricCase c = caseOf("A19", of + "-" + where, scene, ticks);
    c.what = of + (where == "turned" ? ", turned by 37 degrees" : ", " + where + " away") +
             ": farthest from the run at the origin";
    c.kind = kind;
    c.unit = "m";
    c.reference = "the same engine at the origin";
    c.charted = false;
    c.series = [scene, place, ticks](const Setting& setting) {
        return apart(catalogScene(scene), place, ticks, setting);
    };
    return c;
}

/// log₂ of the error with n substeps over that with 2n: how fast work brings an error down.
Result<double> order(const MetricCase& of, const Setting& setting) {
    Setting twice = setting;
    twice.substeps = 2 * setting.substeps;
    const Result<double> coarse = errorOf(of, setting);
    if (!coarse) return coarse;
    const Result<double> fine = errorOf(of, twice);
    if (!fine) return fine;
    return std::log2(*coarse / *fine);
}

MetricCase orderCase(const MetricCase& of) {
    MetricCase c = of;
    c.metric = "A20";
    c.name = of.name + "-order";
    c.what = "order of convergence from n to 2n substeps: " + of.what;
    c.unit = "order";
    c.reference = "log2 of the errors' ratio";
    c.charted = false;
    c.judge = nullptr;
    c.series = [of](const Setting& setting) { return order(of, setting); };
    return c;
}

}  // namespace

void addFrameCases(std::vector<MetricCase>& cases) {
    const Place turned{rotationOf(static_cast<float>(37.0 * pi / 180.0)), {}};
    const struct {
        const char* where;
        Place place;
    } places[] = {
        {"1km", {{}, {1.0e3f, 0.0f}}}, {"20km", {{}, {2.0e4f, 0.0f}}}, {"turned", turned}};
    for (const auto& p : places) {
        cases.push_back(frameCase("double-pendulum", SceneClass::Joint, "double_pendulum",
                                  ticksIn(1.0), p.where, p.place));
        cases.push_back(frameCase("ramp-slide", SceneClass::Friction, "ramp:angle=20,friction=0.3",
                                  ticksIn(2.0), p.where, p.place));
        cases.push_back(
            frameCase("stack", SceneClass::Stack, "stack:n=10", ticksIn(5.0), p.where, p.place));
    }
}

void addOrderCases(std::vector<MetricCase>& cases) {
    for (const char* name : {"pendulum-90-phase", "double-pendulum-1s", "chain-100-hang",
                             "stack-10-sink", "ramp-slide", "bounce-0.5"}) {
        const auto isNamed = [name](const MetricCase& c) { return c.name == name; };
        const auto found = std::find_if(cases.begin(), cases.end(), isNamed);
        assert(found != cases.end());
        MetricCase c = orderCase(*found);  // first: the list may move
        cases.push_back(std::move(c));
    }
}

}  // namespace huestep::tools
