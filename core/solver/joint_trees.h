/// Joints whose graph is a forest, solved at once and exactly instead of one after another.
///
/// The rigid rows of all joints of a tree are one linear system A λ = −r with A = J M⁻¹ Jᵀ, and in
/// a tree a block LDLᵀ of it, from the leaves to the root, fills nothing in: a pass over the tree
/// to factor, one forth and one back to solve (Baraff, "Linear-time dynamics using Lagrange
/// multipliers", 1996). So a chain with a weight of a thousand times its links costs what a light
/// one does, where sweeps would need a thousand passes.
///
/// Which joints, and in which order, is a function of keys alone: joints by id grow a spanning
/// forest; those that would close a loop or hold what is held already stay with the sweeps. A tree
/// is worked off towards its body of lowest id. One worker does it all, so the bits depend on
/// neither threads nor lanes. Springs, motors and limits of all joints stay with the sweeps too.
///
/// A substep that solves with trees goes
///   begin, sweeps, solvePlaces; bodies move; turn, sweeps, solveVelocities
/// which, without anything to sweep, is the scheme RATTLE (Andersen 1983): places are right at its
/// end, then velocities. It keeps a pendulum's energy to a few parts in 100,000 and its period to
/// second order. Where a substep is too long for what goes on in a tree (isWild in
/// joint_trees_solve.cpp) the tree goes through it the damped way instead: linearly implicit in the
/// geometric stiffness (Tournier et al. 2015), which is stable and dissipates.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/graph/plan.h"
#include "core/joint/rigid_rows.h"

namespace huestep {

class Rows;

/// Whether a joint whose row is made leaves anything to sweeps: springs, motors, limits, or all of
/// it.
bool isSwept(const JointRow& row);

/// A symmetric 3 × 3 matrix over (x, y, angle): how a body gives way to an impulse.
struct Mobility {
    double xx = 0, xy = 0, xw = 0, yy = 0, yw = 0, ww = 0;
};

/// An impulse or a velocity of a body, (x, y, angle).
struct Spatial {
    double x = 0, y = 0, w = 0;
};

/// Of a joint's rows.
using RowValues = std::array<double, maxRigidRows>;

/// The trees of one batch. Kept from step to step for its memory alone.
class JointTrees {
 public:
    /// Finds the trees among the batch's joints, which have been made, and marks them `direct`.
    /// Allocates only where there are more of them than ever before.
    void build(const Plan& plan, const Batch& batch, Rows& rows);
    /// Joints that are solved by trees.
    [[nodiscard]] std::size_t size() const { return m_edges.size(); }
    /// Whether the batch has anything that sweeps have to solve.
    [[nodiscard]] bool leavesWork() const { return m_leavesWork; }

    /// Starts a substep of `h` seconds, of which bodies have the velocities that external forces
    /// and warm starts gave them: masses by the joints' impulses of the last one, which are
    /// dropped; then velocities with which the joints hold where the bodies go.
    void begin(Rows& rows, float h);
    /// The same once more, after sweeps, of trees that these touch.
    void solvePlaces(Rows& rows);
    /// After bodies moved: changes velocities so that the joints hold as they go on.
    void turn(Rows& rows);
    /// The same once more, after sweeps, of trees that these touch.
    void solveVelocities(Rows& rows);

 private:
    /// A body: its masses for this substep and what the passes know of it.
    struct Node {
        std::uint32_t place = 0;
        double inverseMass = 0, inverseInertia = 0;  ///< as solved with
        double keptLinear = 1, keptAngular = 1;      ///< real mass by that which is solved with
        double added = 0;                            ///< kg·m², inertia beside its own
        GeometricStiffness stiffness;
        Spatial start;    ///< velocity as the substep began
        Spatial settled;  ///< velocity after the last solve
        Spatial pushed;   ///< N·s, by joints within the substep
        BodyDelta at;
        Mobility mobility;  ///< with all joints below it
        Spatial change;     ///< forth: of its velocity; back: the impulses on it
    };
    /// A joint, from its body on the leaves' side to the one on the root's.
    struct Edge {
        std::uint32_t row = 0;                ///< in `Rows::joints`
        std::uint32_t child = 0, parent = 0;  ///< nodes
        std::uint32_t count = 0;              ///< of rows
        bool parentIsB = true;
        std::array<Spatial, maxRigidRows> ofChild{}, ofParent{};  ///< J
        std::array<double, 6> inverse{};           ///< of A's block: 00, 01, 02, 11, 12, 22
        std::array<Spatial, maxRigidRows> gain{};  ///< that inverse times J Wp
        RigidValues error{};                       ///< at the start of the substep
        RigidValues left{};                        ///< what of it this substep does not correct
        RowValues force{};                         ///< between the passes
    };
    /// What hangs together, in its own part of the lists: of nodes and, leaves first, of edges.
    struct Tree {
        std::uint32_t firstNode = 0, endNode = 0;
        std::uint32_t firstEdge = 0, endEdge = 0;
        bool swept = false;   ///< whether a body of it has a row that is swept
        bool damped = false;  ///< this substep is solved the damped way
        double workOfPlaces = 0, workOfVelocities = 0;  ///< J, by joints within the substep
    };
    enum class For : std::uint8_t { Places, Velocities };

    // Of joint_trees.cpp.
    void findEdges(const Batch& batch, const Rows& rows);
    void orderEdges(const Batch& batch, const Rows& rows);
    void growTree(std::uint32_t root, const Batch& batch, const Rows& rows);
    void dropHeld(Rows& rows);
    void findSwept(const Plan& plan, const Batch& batch, const Rows& rows);
    std::uint32_t addNode(std::uint32_t place, const Rows& rows);

    // Of joint_trees_solve.cpp.
    [[nodiscard]] std::span<Node> nodesOf(const Tree& tree);
    [[nodiscard]] std::span<Edge> edgesOf(const Tree& tree);
    [[nodiscard]] Node& nodeA(const Edge& edge);
    [[nodiscard]] Node& nodeB(const Edge& edge);
    void beginTree(Tree& tree, Rows& rows);
    [[nodiscard]] bool isWildStart(Tree& tree, Rows& rows);
    void backToStart(Tree& tree, Rows& rows);
    void beginDamped(Tree& tree, Rows& rows);
    [[nodiscard]] double kineticOf(const Tree& tree);
    bool isWild(const Tree& tree, float first, float second, const Rows& rows);
    void addStiffness(const Tree& tree, const Rows& rows);
    void setMasses(const Tree& tree, const Rows& rows);
    void factor(const Tree& tree, const Rows& rows, For what);
    void factorEdge(Edge& edge, const JointRow& row, double damping);
    void takeUp(const Tree& tree, const Rows& rows);
    void giveBack(const Tree& tree, Rows& rows);
    float placesOf(Tree& tree, Rows& rows);
    void velocitiesOf(Tree& tree, Rows& rows);
    void takeBack(const Tree& tree, Rows& rows);
    float passForth(const Tree& tree, const Rows& rows, For what);
    void passBack(Tree& tree, Rows& rows, For what);

    float m_h = 0;
    bool m_leavesWork = false;
    std::vector<Tree> m_trees;
    std::vector<Node> m_nodes;
    std::vector<Edge> m_edges;
    // Of building; bodies by place in the batch.
    struct Candidate {
        std::uint32_t row = 0;
        std::uint32_t a = 0, b = 0;
        bool fixed = false;  ///< body `a` does not move
    };
    std::vector<std::uint32_t> m_byKey;
    std::vector<Candidate> m_accepted;
    std::vector<std::uint32_t> m_set, m_joints, m_loops, m_freedom, m_next, m_firstOf, m_edgesOf,
        m_node, m_queue;
    std::vector<std::uint8_t> m_touched;
};

}  // namespace huestep
