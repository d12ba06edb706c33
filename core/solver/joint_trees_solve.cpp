// The passes over trees of joints: masses, factors, forth and back.

#include "core/math/trig.h"
#include "core/solver/joint_trees.h"
#include "core/solver/rows.h"

namespace huestep {

namespace {

/// Least pivot of a block of A, of what the joint's two bodies alone would give. What is less has
/// no direction that impulses move: a taut rope between two walls. As every solve starts from what
/// the last one left, nothing gives way by it. Velocities are known to some 1e-7, and impulses must
/// not make that out to be a load. Passes are in double: in single precision W is lost to rounding
/// where arms are long beside bodies, and forests of random joints fly apart.
constexpr double leastPivot = 1e-8;

/// Most that an error is corrected with, so that joints far off come together as fast as overlap
/// parts, and not in one substep.
constexpr float correctionSpeed = 3.0f;  // m/s
constexpr float correctionTurn = 3.0f;   // rad/s

/// A mass on a spring of stiffness k keeps steady while h² k / m < 4. Masses are made as large as 2
/// asks for; once 4 is passed the substep was too long.
constexpr double steady = 2.0;
constexpr double unsteady = 4.0;

/// Of the added inertia, how much of a relative turn of two bodies that have it is taken out.
constexpr double turnDamping = 0.25;

/// When a substep is too long for a tree: a body turns so far; Newton's method leaves more than
/// that of the error, m or rad, and more than that part of it.
constexpr double longTurn = 0.25;  // rad
constexpr float largeRest = 1e-3f;
constexpr float poorGain = 0.3f;

/// Of the energy that joints take and give within a substep, what they may give too much.
constexpr double energyTolerance = 0.1;
/// And of the tree's kinetic energy: a pendulum's joint gives parts in 100,000 of it in one half of
/// a swing and takes them back in the other.
constexpr double kineticTolerance = 1e-4;

double dot(const Spatial& a, const Spatial& b) {
    return a.x * b.x + a.y * b.y + a.w * b.w;
}
void add(Spatial& to, double s, const Spatial& a) {
    to.x += s * a.x;
    to.y += s * a.y;
    to.w += s * a.w;
}
Spatial times(const Mobility& m, const Spatial& a) {
    return {m.xx * a.x + m.xy * a.y + m.xw * a.w, m.xy * a.x + m.yy * a.y + m.yw * a.w,
            m.xw * a.x + m.yw * a.y + m.ww * a.w};
}
/// m −= a bᵀ, where that is symmetric.
void downdate(Mobility& m, const Spatial& a, const Spatial& b) {
    m.xx -= a.x * b.x;
    m.xy -= a.x * b.y;
    m.xw -= a.x * b.w;
    m.yy -= a.y * b.y;
    m.yw -= a.y * b.w;
    m.ww -= a.w * b.w;
}

/// The inverse of a symmetric matrix (00, 01, 02, 11, 12, 22) by LDLᵀ, with pivots of at least that
/// row's `least`; a row that cannot move gets none.
std::array<double, 6> invert(const std::array<double, 6>& a, const RowValues& least,
                             std::uint32_t count) {
    const auto inverse = [](double pivot) { return pivot > 0.0 ? 1.0 / pivot : 0.0; };
    const double d0 = inverse(maxOf(a[0], least[0]));
    if (count == 1) return {d0};
    const double l10 = a[1] * d0;
    const double d1 = inverse(maxOf(a[3] - l10 * a[1], least[1]));
    if (count == 2) return {d0 + l10 * l10 * d1, -l10 * d1, 0.0, d1};
    const double l20 = a[2] * d0;
    const double u12 = a[4] - l10 * a[2];
    const double l21 = u12 * d1;
    const double d2 = inverse(maxOf((a[5] - l20 * a[2]) - l21 * u12, least[2]));
    // L⁻¹ has −l10 and −l21 below its diagonal, and in the corner:
    const double corner = l10 * l21 - l20;
    return {d0 + l10 * l10 * d1 + corner * corner * d2,
            -l10 * d1 - corner * l21 * d2,
            corner * d2,
            d1 + l21 * l21 * d2,
            -l21 * d2,
            d2};
}

RowValues times(const std::array<double, 6>& m, const RowValues& v) {
    return {m[0] * v[0] + m[1] * v[1] + m[2] * v[2], m[1] * v[0] + m[3] * v[1] + m[4] * v[2],
            m[2] * v[0] + m[4] * v[1] + m[5] * v[2]};
}

double wide(float v) {
    return static_cast<double>(v);
}
float narrow(double v) {
    return static_cast<float>(v);
}
Spatial velocityOf(const SolverBody& b) {
    return {wide(b.vx), wide(b.vy), wide(b.w)};
}

BodyDelta placeNow(const SolverBody& b) {
    return {{b.dx, b.dy}, {b.dc, b.ds}};
}

/// How much of an error a substep leaves.
RigidValues leftOf(const JointRow& row, RigidValues error, float h) {
    const std::uint32_t angle = angleRow(row);
    float square = 0.0f;
    for (std::uint32_t k = 0; k < maxRigidRows; ++k) {
        if (k != angle) square += error[k] * error[k];
    }
    const float size = std::sqrt(square);
    const auto share = [](float of, float most) { return of > most ? 1.0f - most / of : 0.0f; };
    for (std::uint32_t k = 0; k < maxRigidRows; ++k) {
        error[k] *= k == angle ? share(absoluteOf(error[k]), h * correctionTurn)
                               : share(size, h * correctionSpeed);
    }
    return error;
}

}  // namespace

std::span<JointTrees::Node> JointTrees::nodesOf(const Tree& tree) {
    return std::span(m_nodes).subspan(tree.firstNode, tree.endNode - tree.firstNode);
}
std::span<JointTrees::Edge> JointTrees::edgesOf(const Tree& tree) {
    return std::span(m_edges).subspan(tree.firstEdge, tree.endEdge - tree.firstEdge);
}
JointTrees::Node& JointTrees::nodeA(const Edge& edge) {
    return m_nodes[edge.parentIsB ? edge.child : edge.parent];
}
JointTrees::Node& JointTrees::nodeB(const Edge& edge) {
    return m_nodes[edge.parentIsB ? edge.parent : edge.child];
}

/// Into `change`: what the joints' impulses of now make of each body's stiffness.
void JointTrees::addStiffness(const Tree& tree, const Rows& rows) {
    for (Node& node : nodesOf(tree)) {
        node.at = placeNow(rows.bodies[node.place]);
        node.change = {};
    }
    for (const Edge& edge : edgesOf(tree)) {
        const JointRow& row = rows.joints[edge.row];
        Node& a = nodeA(edge);
        Node& b = nodeB(edge);
        const JointStiffness k = geometricStiffness(row, rigidImpulses(row), a.at, b.at);
        a.change.x += wide(k.a.linear);
        a.change.w += wide(k.a.angular);
        b.change.x += wide(k.b.linear);
        b.change.w += wide(k.b.angular);
    }
}

/// A rope under tension swings across like a string, and its links turn under it with frequencies
/// of which √(K/I) is a bound: a chain of 1 kg links with a ton on it needs h < 1/400 s for what
/// nobody sees.
///
/// So a body takes part in its tree with at least the mass and the inertia that its geometric
/// stiffness asks for, h² K / 2. As it is inertia that is added, and no damping, energy is kept,
/// and whatever is at rest is where it should be. Light bodies under great loads alone get it, and
/// beside such loads they weigh nothing.
///
/// The damped way adds h² K to every mass and lets none of it have a velocity: (M + h² K) v⁺ =
/// M v + …: implicit Euler. It costs a swinging chain a tenth of its energy in 10 s at n = 4.
void JointTrees::setMasses(const Tree& tree, const Rows& rows) {
    for (Node& node : nodesOf(tree)) {
        const double inverseMass = wide(rows.bodies[node.place].inverseMass);
        const double inverseInertia = wide(rows.sources[node.place].inverseInertia);
        // Impulses over h are forces, so K comes with one h less.
        const double h = wide(m_h);
        const auto kept = [&](double ratio) {
            if (tree.damped) return 1.0 / (1.0 + ratio);
            return ratio > steady ? steady / ratio : 1.0;
        };
        node.keptLinear = kept(h * maxOf(wide(node.stiffness.linear), 0.0) * inverseMass);
        node.keptAngular = kept(h * maxOf(wide(node.stiffness.angular), 0.0) * inverseInertia);
        node.inverseMass = node.keptLinear * inverseMass;
        node.inverseInertia = node.keptAngular * inverseInertia;
        node.added = inverseInertia > 0.0 ? 1.0 / node.inverseInertia - 1.0 / inverseInertia : 0.0;
    }
}

/// With W a body's mobility less what its joints further out take of it, a joint's block is
///   A = Jc Wc Jcᵀ + Jp Wp Jpᵀ,   and leaves the parent with   Wp − Wp Jpᵀ A⁻¹ Jp Wp.
/// `damping`: kg·m², of the relative turn, as a third row that gives way; 0: none.
void JointTrees::factorEdge(Edge& edge, const JointRow& row, double damping) {
    Node& parent = m_nodes[edge.parent];
    const Node& child = m_nodes[edge.child];
    const auto jacobian = rigidRows(row, nodeA(edge).at, nodeB(edge).at);
    edge.count = damping > 0.0 ? maxRigidRows : rigidRowCount(row);
    std::array<Spatial, maxRigidRows> byChild{}, byParent{};
    RowValues least{};
    for (std::uint32_t k = 0; k < edge.count; ++k) {
        const RigidRow& j = jacobian[k];
        const Spatial ofA{wide(-j.n.x), wide(-j.n.y), wide(-j.armA)};
        const Spatial ofB{wide(j.n.x), wide(j.n.y), wide(j.armB)};
        edge.ofChild[k] = edge.parentIsB ? ofA : ofB;
        edge.ofParent[k] = edge.parentIsB ? ofB : ofA;
        byChild[k] = times(child.mobility, edge.ofChild[k]);
        byParent[k] = times(parent.mobility, edge.ofParent[k]);
        const double armC = edge.ofChild[k].w, armP = edge.ofParent[k].w;
        least[k] =
            leastPivot * (wide(lengthSquared(j.n)) * (child.inverseMass + parent.inverseMass) +
                          armC * armC * child.inverseInertia + armP * armP * parent.inverseInertia);
    }
    std::array<double, 6> block{};
    for (std::uint32_t i = 0; i < edge.count; ++i) {
        const std::uint32_t first = i == 0 ? 0 : i + 1;  // where row i starts, less i
        for (std::uint32_t k = i; k < edge.count; ++k) {
            block[first + k] =
                dot(edge.ofChild[i], byChild[k]) + dot(edge.ofParent[i], byParent[k]);
        }
    }
    if (damping > 0.0) block[5] += 1.0 / damping;
    edge.inverse = invert(block, least, edge.count);
    const std::array<double, 6>& m = edge.inverse;
    const std::array<RowValues, maxRigidRows> full{
        {{m[0], m[1], m[2]}, {m[1], m[3], m[4]}, {m[2], m[4], m[5]}}};
    for (std::uint32_t i = 0; i < edge.count; ++i) {
        edge.gain[i] = {};
        for (std::uint32_t k = 0; k < edge.count; ++k) add(edge.gain[i], full[i][k], byParent[k]);
        downdate(parent.mobility, byParent[i], edge.gain[i]);
    }
}

/// At the places in `at`. Two bodies with inertia added, whose turns against each other nobody
/// sees, are braked in these; what they do together goes on.
void JointTrees::factor(const Tree& tree, const Rows& rows, For what) {
    for (Node& node : nodesOf(tree)) {
        node.mobility = {};
        node.mobility.xx = node.mobility.yy = node.inverseMass;
        node.mobility.ww = node.inverseInertia;
    }
    for (Edge& edge : edgesOf(tree)) {
        const JointRow& row = rows.joints[edge.row];
        double damping = 0.0;
        if (what == For::Velocities && !tree.damped && row.kind == JointKind::Revolute) {
            damping = turnDamping * minOf(m_nodes[edge.child].added, m_nodes[edge.parent].added);
        }
        factorEdge(edge, row, damping);
    }
}

/// What everything else did to the bodies since the last solve, they answer with the masses that
/// they have here.
void JointTrees::takeUp(const Tree& tree, const Rows& rows) {
    for (Node& node : nodesOf(tree)) {
        const Spatial now = velocityOf(rows.bodies[node.place]);
        Spatial& v = node.settled;
        v.x += node.keptLinear * (now.x - v.x);
        v.y += node.keptLinear * (now.y - v.y);
        v.w += node.keptAngular * (now.w - v.w);
    }
}

void JointTrees::giveBack(const Tree& tree, Rows& rows) {
    for (const Node& node : nodesOf(tree)) {
        if (!(node.inverseMass > 0.0)) continue;
        SolverBody& b = rows.bodies[node.place];
        b.vx = narrow(node.settled.x);
        b.vy = narrow(node.settled.y);
        b.w = narrow(node.settled.w);
    }
}

/// Forth: what each joint pushes with, should its parent's other joints not be. Returns the largest
/// error, m or rad.
float JointTrees::passForth(const Tree& tree, const Rows& rows, For what) {
    const double rate = 1.0 / wide(m_h);
    float largest = 0.0f;
    for (Edge& edge : edgesOf(tree)) {
        Node& parent = m_nodes[edge.parent];
        const Node& child = m_nodes[edge.child];
        RowValues rest{};
        if (what == For::Places) {
            const RigidValues error =
                tree.damped ? edge.error
                            : rigidErrors(rows.joints[edge.row], nodeA(edge).at, nodeB(edge).at);
            for (std::uint32_t k = 0; k < edge.count; ++k) {
                const float off = error[k] - edge.left[k];
                largest = maxOf(largest, absoluteOf(off));
                rest[k] = rate * wide(off);
            }
        }
        for (std::uint32_t k = 0; k < edge.count; ++k) {
            rest[k] += dot(edge.ofChild[k], child.change) + dot(edge.ofParent[k], parent.change);
        }
        edge.force = times(edge.inverse, rest);
        for (std::uint32_t k = 0; k < edge.count; ++k) {
            add(parent.change, -rest[k], edge.gain[k]);
        }
    }
    return largest;
}

/// Back: what it does as they are; impulses are counted and velocities changed.
void JointTrees::passBack(Tree& tree, Rows& rows, For what) {
    const std::span<Node> nodes = nodesOf(tree);
    const std::span<Edge> edges = edgesOf(tree);
    for (Node& node : nodes) node.change = {};
    for (auto edge = edges.rbegin(); edge != edges.rend(); ++edge) {
        Node& parent = m_nodes[edge->parent];
        Node& child = m_nodes[edge->child];
        JointRow& row = rows.joints[edge->row];
        RigidValues impulses = rigidImpulses(row);
        const Spatial onParent = parent.change;
        for (std::uint32_t k = 0; k < edge->count; ++k) {
            const double impulse = -edge->force[k] - dot(edge->gain[k], onParent);
            impulses[k] += narrow(impulse);
            add(parent.change, impulse, edge->ofParent[k]);
            add(child.change, impulse, edge->ofChild[k]);
        }
        setRigidImpulses(row, impulses);
    }
    double work = 0.0;
    for (Node& node : nodes) {
        Spatial& v = node.settled;
        const Spatial was = v;
        v.x += node.inverseMass * node.change.x;
        v.y += node.inverseMass * node.change.y;
        v.w += node.inverseInertia * node.change.w;
        add(node.pushed, 1.0, node.change);
        work += 0.5 * (dot(node.change, was) + dot(node.change, v));
    }
    (what == For::Places ? tree.workOfPlaces : tree.workOfVelocities) += work;
    giveBack(tree, rows);
}

/// One step of Newton's method for C = what is to be left of it at the substep's end; returns the
/// largest error before it. The Jacobian is that of the start, as the scheme wants it. The damped
/// way is content with C to first order.
float JointTrees::placesOf(Tree& tree, Rows& rows) {
    takeUp(tree, rows);
    for (Node& node : nodesOf(tree)) {
        const Spatial& v = node.settled;
        const SolverBody& b = rows.bodies[node.place];
        const Vec2 lag = rows.sources[node.place].lag;
        const Spatial mean{v.x - wide(lag.x), v.y - wide(lag.y), v.w};
        node.change = tree.damped ? mean : Spatial{};
        node.at.moved = {b.dx + m_h * narrow(mean.x), b.dy + m_h * narrow(mean.y)};
        node.at.turned = compose(cayley(0.5f * m_h * narrow(v.w)), Rotation{b.dc, b.ds});
    }
    const float largest = passForth(tree, rows, For::Places);
    passBack(tree, rows, For::Places);
    return largest;
}

void JointTrees::velocitiesOf(Tree& tree, Rows& rows) {
    takeUp(tree, rows);
    for (Node& node : nodesOf(tree)) node.change = node.settled;
    passForth(tree, rows, For::Velocities);
    passBack(tree, rows, For::Velocities);
}

/// Whether the substep is too long for what goes on in the tree. `first`, `second`: errors before
/// the first and the second step of Newton's method.
bool JointTrees::isWild(const Tree& tree, float first, float second, const Rows& rows) {
    bool wild = second > largeRest && second > poorGain * first;
    addStiffness(tree, rows);
    for (const Node& node : nodesOf(tree)) {
        // By half of the impulses that a substep has.
        const double h = wide(m_h);
        const double linear = 2.0 * h * node.change.x * node.inverseMass;
        const double angular = 2.0 * h * node.change.w * node.inverseInertia;
        const bool turns = node.inverseMass > 0.0 && absoluteOf(node.settled.w) * h > longTurn;
        wild = wild || linear > unsteady || angular > unsteady || turns;
    }
    return wild;
}

void JointTrees::beginTree(Tree& tree, Rows& rows) {
    tree.damped = false;
    tree.workOfPlaces = tree.workOfVelocities = 0.0;
    addStiffness(tree, rows);
    for (Node& node : nodesOf(tree)) {
        const SolverBody& b = rows.bodies[node.place];
        node.stiffness = {narrow(node.change.x), narrow(node.change.w)};
        node.start = velocityOf(b);
        node.pushed = {};
    }
    for (Edge& edge : edgesOf(tree)) {
        JointRow& row = rows.joints[edge.row];
        setRigidImpulses(row, {});
        edge.error = rigidErrors(row, nodeA(edge).at, nodeB(edge).at);
        edge.left = leftOf(row, edge.error, m_h);
    }
    if (!isWildStart(tree, rows)) return;
    // The last substep's impulses, of which stiffness was made, may tell nothing of this one's: an
    // arm that whirls from its first step on would lose a tenth of its energy in the damped way.
    backToStart(tree, rows);
    if (!isWildStart(tree, rows)) return;
    backToStart(tree, rows);
    beginDamped(tree, rows);
}

/// Places by two steps of Newton's method, with the stiffness that nodes have; whether that is
/// wild.
bool JointTrees::isWildStart(Tree& tree, Rows& rows) {
    setMasses(tree, rows);
    factor(tree, rows, For::Places);
    const float first = placesOf(tree, rows);
    const float second = placesOf(tree, rows);
    return isWild(tree, first, second, rows);
}

/// To the start of the substep again, with the stiffness that its impulses turned out to make.
void JointTrees::backToStart(Tree& tree, Rows& rows) {
    for (Node& node : nodesOf(tree)) {
        node.stiffness.linear = maxOf(node.stiffness.linear, 2.0f * narrow(node.change.x));
        node.stiffness.angular = maxOf(node.stiffness.angular, 2.0f * narrow(node.change.w));
        node.settled = {};
        node.pushed = {};
        if (!(node.inverseMass > 0.0)) continue;
        SolverBody& b = rows.bodies[node.place];
        b.vx = narrow(node.start.x);
        b.vy = narrow(node.start.y);
        b.w = narrow(node.start.w);
    }
    for (Edge& edge : edgesOf(tree)) setRigidImpulses(rows.joints[edge.row], {});
    for (Node& node : nodesOf(tree)) node.at = placeNow(rows.bodies[node.place]);
}

/// The substep the damped way.
void JointTrees::beginDamped(Tree& tree, Rows& rows) {
    tree.damped = true;
    setMasses(tree, rows);
    factor(tree, rows, For::Places);
    placesOf(tree, rows);
}

/// J, as velocities are now.
double JointTrees::kineticOf(const Tree& tree) {
    double energy = 0.0;
    for (const Node& node : nodesOf(tree)) {
        const Spatial& v = node.settled;
        if (node.inverseMass > 0.0) {
            energy += 0.5 * (v.x * v.x + v.y * v.y) / node.inverseMass;
        }
        if (node.inverseInertia > 0.0) energy += 0.5 * v.w * v.w / node.inverseInertia;
    }
    return energy;
}

/// Without what joints pushed within the substep.
void JointTrees::takeBack(const Tree& tree, Rows& rows) {
    for (const Edge& edge : edgesOf(tree)) setRigidImpulses(rows.joints[edge.row], {});
    for (Node& node : nodesOf(tree)) {
        Spatial& v = node.settled;
        v.x -= node.inverseMass * node.pushed.x;
        v.y -= node.inverseMass * node.pushed.y;
        v.w -= node.inverseInertia * node.pushed.w;
    }
    giveBack(tree, rows);
}

void JointTrees::begin(Rows& rows, float h) {
    m_h = h;
    for (Tree& tree : m_trees) beginTree(tree, rows);
}

void JointTrees::solvePlaces(Rows& rows) {
    for (Tree& tree : m_trees) {
        if (tree.swept) placesOf(tree, rows);
    }
}

/// Joints that hold do no work: what they give while places are solved for they take while
/// velocities are. Where they give much more than they take the substep was too long, and bodies
/// keep nothing of what places needed: that is a projection, which gives none.
void JointTrees::turn(Rows& rows) {
    for (Tree& tree : m_trees) {
        for (Node& node : nodesOf(tree)) node.at = placeNow(rows.bodies[node.place]);
        factor(tree, rows, For::Velocities);
        velocitiesOf(tree, rows);
        const double given = tree.workOfPlaces + tree.workOfVelocities;
        const double both = absoluteOf(tree.workOfPlaces) + absoluteOf(tree.workOfVelocities);
        if (tree.damped || !(given > energyTolerance * both)) continue;
        if (!(given > kineticTolerance * kineticOf(tree))) continue;
        takeBack(tree, rows);
        velocitiesOf(tree, rows);
    }
}

void JointTrees::solveVelocities(Rows& rows) {
    for (Tree& tree : m_trees) {
        if (tree.swept) velocitiesOf(tree, rows);
    }
}

}  // namespace huestep
