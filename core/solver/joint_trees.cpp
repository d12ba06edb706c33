// Which joints are solved as trees, and in which order: from keys alone.

#include "core/solver/joint_trees.h"

#include <algorithm>
#include <numeric>

#include "core/solver/rows.h"

namespace huestep {

namespace {

constexpr std::uint32_t netShare = 8;

std::uint32_t find(std::vector<std::uint32_t>& set, std::uint32_t i) {
    while (set[i] != i) i = set[i] = set[set[i]];
    return i;
}

}  // namespace

bool isSwept(const JointRow& row) {
    return !row.direct || hasParts(row);
}

/// Joints by id grow a forest; those that close a loop are left out. Where more than one in eight
/// does, what hangs together is a net and no tree, and all of it is left to the sweeps: those would
/// be at odds with the forest at every other joint.
void JointTrees::findEdges(const Batch& batch, const Rows& rows) {
    m_set.resize(batch.endPlace - batch.firstPlace);
    std::iota(m_set.begin(), m_set.end(), 0u);
    m_byKey.resize(batch.endJoint - batch.firstJoint);
    std::iota(m_byKey.begin(), m_byKey.end(), batch.firstJoint);
    std::sort(m_byKey.begin(), m_byKey.end(), [&](std::uint32_t i, std::uint32_t j) {
        return rows.joints[i].joint < rows.joints[j].joint;
    });
    m_accepted.clear();
    m_loops.assign(m_set.size(), 0);
    m_joints.assign(m_set.size(), 0);
    for (const std::uint32_t i : m_byKey) {
        const JointRow& row = rows.joints[i];
        if (rigidRowCount(row) == 0 || (row.bodyA < 0 && row.bodyB < 0)) continue;
        const auto placeOf = [&](BodyPlace place) {
            return static_cast<std::uint32_t>(readPlace(place)) - batch.firstPlace;
        };
        Candidate c{i, placeOf(row.bodyA), placeOf(row.bodyB), row.bodyA < 0 || row.bodyB < 0};
        if (row.bodyB < 0) std::swap(c.a, c.b);
        if (!c.fixed) {
            const std::uint32_t setA = find(m_set, c.a), setB = find(m_set, c.b);
            const std::uint32_t low = std::min(setA, setB), high = std::max(setA, setB);
            ++m_joints[low];
            if (low == high) {
                ++m_loops[low];
                continue;
            }
            m_set[high] = low;
            m_joints[low] += m_joints[high];
            m_loops[low] += m_loops[high];
        }
        m_accepted.push_back(c);
    }
    std::erase_if(m_accepted, [&](const Candidate& c) {
        const std::uint32_t set = find(m_set, c.b);
        return netShare * m_loops[set] > m_joints[set];
    });
}

std::uint32_t JointTrees::addNode(std::uint32_t place, const Rows& rows) {
    const SolverBody& b = rows.bodies[place];
    Node node;
    node.place = place;
    node.settled = {static_cast<double>(b.vx), static_cast<double>(b.vy), static_cast<double>(b.w)};
    m_nodes.push_back(node);
    return static_cast<std::uint32_t>(m_nodes.size() - 1);
}

/// From the body outwards, joints of a body by falling id; then all of it backwards. A body that
/// does not move is a leaf of each of its joints.
void JointTrees::growTree(std::uint32_t root, const Batch& batch, const Rows& rows) {
    Tree tree;
    tree.firstNode = static_cast<std::uint32_t>(m_nodes.size());
    tree.firstEdge = static_cast<std::uint32_t>(m_edges.size());
    m_queue.assign(1, root);
    m_node[root] = addNode(batch.firstPlace + root, rows);
    for (std::size_t at = 0; at < m_queue.size(); ++at) {
        const std::uint32_t body = m_queue[at];
        for (std::uint32_t k = m_firstOf[body + 1]; k-- > m_firstOf[body];) {
            const Candidate& c = m_accepted[m_edgesOf[k]];
            const std::uint32_t other = c.a == body ? c.b : c.a;
            if (!c.fixed && m_node[other] != none) continue;  // the way here
            Edge edge;
            edge.row = c.row;
            edge.parent = m_node[body];
            edge.child = addNode(batch.firstPlace + other, rows);
            const auto placeB = static_cast<std::uint32_t>(readPlace(rows.joints[c.row].bodyB));
            edge.parentIsB = placeB - batch.firstPlace == body;
            m_edges.push_back(edge);
            if (c.fixed) continue;
            m_node[other] = edge.child;
            m_queue.push_back(other);
        }
    }
    tree.endNode = static_cast<std::uint32_t>(m_nodes.size());
    tree.endEdge = static_cast<std::uint32_t>(m_edges.size());
    std::reverse(m_edges.begin() + tree.firstEdge, m_edges.end());
    m_trees.push_back(tree);
}

void JointTrees::orderEdges(const Batch& batch, const Rows& rows) {
    const std::uint32_t places = batch.endPlace - batch.firstPlace;
    m_firstOf.assign(places + 1, 0);
    for (const Candidate& c : m_accepted) {
        ++m_firstOf[c.b + 1];
        if (!c.fixed) ++m_firstOf[c.a + 1];
    }
    std::partial_sum(m_firstOf.begin(), m_firstOf.end(), m_firstOf.begin());
    m_edgesOf.resize(m_firstOf.back());
    m_next.assign(m_firstOf.begin(), m_firstOf.end() - 1);  // where the next one of a body goes
    for (std::uint32_t i = 0; i < m_accepted.size(); ++i) {
        const Candidate& c = m_accepted[i];
        m_edgesOf[m_next[c.b]++] = i;
        if (!c.fixed) m_edgesOf[m_next[c.a]++] = i;
    }
    m_trees.clear();
    m_nodes.clear();
    m_edges.clear();
    m_node.assign(places, none);
    for (std::uint32_t root = 0; root < places; ++root) {
        const bool joined = m_firstOf[root] != m_firstOf[root + 1];
        if (joined && m_node[root] == none) growTree(root, batch, rows);
    }
}

/// A joint that holds what is held already has no solution but by chance, and its rows would be
/// noise by noise. So it is left to the sweeps where, in general, both of its bodies together have
/// less freedom left than it has rows: leaves first, a joint takes from its parent what its child
/// does not have to give.
void JointTrees::dropHeld(Rows& rows) {
    m_freedom.resize(m_nodes.size());
    for (std::size_t i = 0; i < m_nodes.size(); ++i) {
        const std::uint32_t place = m_nodes[i].place;
        const bool moves = rows.bodies[place].inverseMass > 0.0f;
        const bool turns = rows.sources[place].inverseInertia > 0.0f;
        m_freedom[i] = (moves ? 2u : 0u) + (turns ? 1u : 0u);
    }
    std::uint32_t kept = 0;
    for (Tree& tree : m_trees) {
        const std::uint32_t first = tree.firstEdge;
        tree.firstEdge = kept;
        for (std::uint32_t at = first; at < tree.endEdge; ++at) {
            const Edge& edge = m_edges[at];
            JointRow& row = rows.joints[edge.row];
            const std::uint32_t count = rigidRowCount(row);
            const std::uint32_t ofChild = std::min(m_freedom[edge.child], count);
            if (ofChild + m_freedom[edge.parent] < count) continue;
            const auto inertia = [&](std::uint32_t node) {
                return rows.sources[m_nodes[node].place].inverseInertia;
            };
            const bool turns = inertia(edge.child) > 0.0f || inertia(edge.parent) > 0.0f;
            if (angleRow(row) < maxRigidRows && !turns) continue;
            m_freedom[edge.parent] -= count - ofChild;
            row.direct = true;
            m_edges[kept++] = edge;
        }
        tree.endEdge = kept;
    }
    m_edges.resize(kept);
}

/// Whom sweeps touch is a matter of its own constraints alone: other islands may lie in the batch.
void JointTrees::findSwept(const Plan& plan, const Batch& batch, const Rows& rows) {
    m_touched.assign(plan.hasContact.begin() + batch.firstPlace,
                     plan.hasContact.begin() + batch.endPlace);
    m_leavesWork =
        batch.firstBlock < batch.endBlock || batch.firstRevoluteBlock < batch.endRevoluteBlock;
    for (std::uint32_t i = batch.firstJoint; i < batch.endJoint; ++i) {
        const JointRow& row = rows.joints[i];
        if (!isSwept(row)) continue;
        m_leavesWork = true;
        for (const BodyPlace place : {row.bodyA, row.bodyB}) {
            if (place >= 0) m_touched[static_cast<std::uint32_t>(place) - batch.firstPlace] = 1;
        }
    }
    for (Tree& tree : m_trees) {
        tree.swept = false;
        for (std::uint32_t i = tree.firstNode; i < tree.endNode; ++i) {
            const std::uint32_t place = m_nodes[i].place;
            const bool moves = rows.bodies[place].inverseMass > 0.0f;
            tree.swept = tree.swept || (moves && m_touched[place - batch.firstPlace] != 0);
        }
    }
}

void JointTrees::build(const Plan& plan, const Batch& batch, Rows& rows) {
    findEdges(batch, rows);
    orderEdges(batch, rows);
    dropHeld(rows);
    findSwept(plan, batch, rows);
}

}  // namespace huestep
