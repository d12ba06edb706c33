// R: where bodies are at every tick, beside the reference solver; of each scene once against rigid
// bodies and once against the same soft rows, solved to the end in double.

#include <algorithm>
#include <cassert>
#include <cmath>
#include <mutex>

#include "tools/metrics/case_lists.h"
#include "tools/metrics/judges.h"
#include "tools/metrics/scenes.h"
#include "tools/reference/reference_world.h"

namespace huestep::tools {
namespace {

using reference::Trajectory;

/// A scene's trajectory, solved when it is first asked for. Thread rule: any.
class Solved {
 public:
    Solved(std::function<Scene()> scene, std::uint64_t ticks, int substeps)
        : m_scene(std::move(scene)), m_ticks(ticks), m_substeps(substeps) {}
    const Trajectory& get() {
        std::call_once(m_once, [this] {
            const Result<World> start = World::create(m_scene());
            assert(start.ok());
            reference::Accuracy accuracy;
            accuracy.substeps = m_substeps;
            Result<Trajectory> solved = reference::follow(*start, m_ticks, accuracy);
            assert(solved.ok());
            m_trajectory = std::move(solved).value();
        });
        return m_trajectory;
    }

 private:
    std::function<Scene()> m_scene;
    std::uint64_t m_ticks;
    int m_substeps;
    std::once_flag m_once;
    Trajectory m_trajectory;
};

/// Root of the mean square, over ticks, of how far the farthest body is off.
std::unique_ptr<Judge> besides(const World& world, const Trajectory& truth) {
    std::vector<std::vector<Vec2d>> positions;
    for (const std::vector<reference::Body>& bodies : truth.ticks) {
        positions.emplace_back();
        for (const reference::Body& body : bodies) positions.back().push_back(body.position);
    }
    return folded(world, Fold::Rms, {}, [positions](const Frame& f) {
        if (f.tick >= positions.size()) return failed;
        double most = 0.0;
        for (std::size_t i = 0; i < f.motions.size(); ++i) {
            const double off = length(positionOf(f, i) - positions[f.tick][i]);
            most = std::isfinite(off) ? std::max(most, off) : failed;
        }
        return most;
    });
}

/// `substeps`: of the reference, which is solved with twice as many again.
void addRigid(std::vector<MetricCase>& cases, std::string name, SceneClass kind,
              const std::string& what, double seconds, int substeps,
              const std::function<Scene()>& scene) {
    MetricCase c;
    c.metric = "R";
    c.name = std::move(name);
    c.what = what + ": rms distance of the farthest body from the truth";
    c.kind = kind;
    c.unit = "m";
    c.reference = "reference solver, rigid";
    c.charted = true;
    c.ticks = ticksIn(seconds);
    c.scene = scene;
    const auto solved = std::make_shared<Solved>(scene, c.ticks, substeps);
    c.uncertainty = [solved] { return solved->get().uncertainty; };
    c.judge = [solved](const World& start) { return besides(start, solved->get()); };
    cases.push_back(std::move(c));
}

/// The last case once more, beside soft rows that are solved to the end.
void addSoft(std::vector<MetricCase>& cases) {
    MetricCase c = cases.back();
    c.name += "-model";
    c.reference = "reference solver, same soft rows";
    c.truth = Truth::SoftModel;
    c.charted = false;
    c.uncertainty = nullptr;
    c.judge = [ticks = c.ticks](const World& start) {
        reference::Accuracy accuracy;
        accuracy.substeps = static_cast<int>(start.info().substeps);
        accuracy.soft = reference::SoftRows::ofProduct(start.info());
        const Result<Trajectory> same = reference::follow(start, ticks, accuracy);
        assert(same.ok());
        return besides(start, *same);
    };
    cases.push_back(std::move(c));
}

}  // namespace

void addTrajectoryCases(std::vector<MetricCase>& cases) {
    // Impacts of one point at a time alone: of several at once rigid bodies know no one answer.
    addRigid(cases, "slide-down", SceneClass::Friction, "a box that slides down 20 degrees for 1 s",
             1.0, 64, [] { return catalogScene("ramp:angle=20,friction=0.3"); });
    addSoft(cases);
    addRigid(cases, "tipping-box", SceneClass::Impact, "a box that tips over and lands, 0.75 s",
             0.75, 512, tippingBox);
    addSoft(cases);
    addRigid(cases, "see-saw", SceneClass::Mixed, "two boxes that slide on a hinged bar, 0.75 s",
             0.75, 256, seesaw);
    addSoft(cases);
    // Soft rows of the reference solver know no restitution.
    addRigid(cases, "meeting-pendulums", SceneClass::Mixed,
             "a swinging disc that hits a hanging one, 1 s", 1.0, 256, meetingPendulums);
}

}  // namespace huestep::tools
