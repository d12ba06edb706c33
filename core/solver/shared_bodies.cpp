#include "core/solver/shared_bodies.h"

#include <algorithm>
#include <atomic>

#include "core/parallel/thread.h"
#include "core/solver/contact_kernels.h"
#include "core/solver/lane_copies.h"
#include "core/solver/soft_step.h"

namespace huestep {

namespace {

/// Hands a batch's constraints to all workers, one after another, moving bodies first. `One` has
/// `joint(row, f)` and `contact(block, lane, f)`, which see to it that `f(bodies)` may work on the
/// constraint's bodies.
template <class One>
class KeyOrderSweeper final : public Sweeper {
 public:
    KeyOrderSweeper(const BatchTask& task, const Team& team, One& one)
        : m_task(task), m_team(team), m_one(one) {}

    void sweep(const Sweep& sweep, const SweepPass& pass) override {
        Rows& rows = m_task.rows;
        for (std::uint32_t r = m_task.batch.firstColour; r < m_task.batch.endColour; ++r) {
            const ColourRun& run = m_task.plan.runs[r];
            const Share joints(sweep.joint != nullptr ? run.jointCount : 0, m_team);
            for (std::uint32_t i = joints.begin; i < joints.end; ++i) {
                JointRow& row = rows.joints[run.firstJoint + i];
                m_one.joint(row, [&](SolverBody* bodies) { sweep.joint(bodies, row, pass.joint); });
            }
            const ContactLanePass solve = contactLanePasses().*sweep.lane;
            const ContactPass& contact = contactPassOf(pass, run.colour);
            const Share blocks(blocksOf(run.contactCount), m_team);
            const std::uint32_t end = std::min(blocks.end * blockLanes, run.contactCount);
            for (std::uint32_t i = blocks.begin * blockLanes; i < end; ++i) {
                const std::uint32_t lane = i % blockLanes;
                ContactBlock& block = rows.blocks[run.firstBlock + i / blockLanes];
                m_one.contact(block, lane,
                              [&](SolverBody* bodies) { solve(bodies, block, lane, contact); });
            }
            m_team.barrier();
        }
    }

 private:
    const BatchTask& m_task;
    Team m_team;
    One& m_one;
};

/// Two bodies' locks, held as long as this is.
class Held {
 public:
    Held(std::vector<std::uint32_t>& locks, BodyPlace a, BodyPlace b)
        : m_locks(locks), m_first(std::min(a, b)), m_second(std::max(a, b)) {
        lock(m_first);
        if (m_second != m_first) lock(m_second);
    }
    ~Held() {
        unlock(m_first);
        if (m_second != m_first) unlock(m_second);
    }
    Held(const Held&) = delete;
    Held& operator=(const Held&) = delete;

 private:
    static constexpr int patience = 64;  // looks before another thread is let run

    void lock(BodyPlace place) {
        if (place < 0) return;  // it is only read
        const std::atomic_ref<std::uint32_t> taken(m_locks[static_cast<std::size_t>(place)]);
        int looks = 0;
        while (taken.exchange(1, std::memory_order_acquire) != 0) {
            while (taken.load(std::memory_order_relaxed) != 0) {
                if (++looks % patience == 0) letOthersRun();
            }
        }
    }
    void unlock(BodyPlace place) {
        if (place < 0) return;
        const std::atomic_ref<std::uint32_t> taken(m_locks[static_cast<std::size_t>(place)]);
        taken.store(0, std::memory_order_release);
    }

    std::vector<std::uint32_t>& m_locks;
    BodyPlace m_first, m_second;
};

/// Works on the bodies themselves, under their locks.
struct UnderLocks {
    Rows& rows;

    template <class F>
    void joint(JointRow& row, F&& f) {
        const Held held(rows.memory.locks, row.bodyA, row.bodyB);
        f(rows.bodies.data());
    }
    template <class F>
    void contact(ContactBlock& block, std::uint32_t lane, F&& f) {
        const Held held(rows.memory.locks, block.bodyA[lane], block.bodyB[lane]);
        f(rows.bodies.data());
    }
};

/// Works on copies, and adds what became of them.
struct WithAtomics {
    Rows& rows;
    LaneCopies copies{};

    template <class F>
    void joint(JointRow& row, F&& f) {
        const BodyPlace a = row.bodyA, b = row.bodyB;
        row.bodyA = copyPlace(a, 0);
        row.bodyB = copyPlace(b, 1);
        work(a, copies[0], b, copies[1], f);
        row.bodyA = a;
        row.bodyB = b;
    }
    template <class F>
    void contact(ContactBlock& block, std::uint32_t lane, F&& f) {
        const BodyPlace a = block.bodyA[lane], b = block.bodyB[lane];
        const BodyPlace warmA = block.warmA[lane], warmB = block.warmB[lane];
        block.bodyA[lane] = copyPlace(a, 0);
        block.bodyB[lane] = copyPlace(b, 1);
        block.warmA[lane] = copyPlace(warmA, 0);
        block.warmB[lane] = copyPlace(warmB, 1);
        work(a, copies[0], b, copies[1], f);
        block.bodyA[lane] = a;
        block.bodyB[lane] = b;
        block.warmA[lane] = warmA;
        block.warmB[lane] = warmB;
    }

 private:
    template <class F>
    void work(BodyPlace a, SolverBody& copyA, BodyPlace b, SolverBody& copyB, F&& f) {
        const SolverBody fromA = copyA = read(a), fromB = copyB = read(b);
        f(copies.data());
        add(a, fromA, copyA);
        add(b, fromB, copyB);
    }
    [[nodiscard]] SolverBody read(BodyPlace place) {
        SolverBody& body = rows.bodies[static_cast<std::size_t>(readPlace(place))];
        if (place < 0) return body;
        SolverBody copy;
        copy.vx = std::atomic_ref(body.vx).load(std::memory_order_relaxed);
        copy.vy = std::atomic_ref(body.vy).load(std::memory_order_relaxed);
        copy.w = std::atomic_ref(body.w).load(std::memory_order_relaxed);
        copy.inverseMass = body.inverseMass;
        copy.dx = body.dx;
        copy.dy = body.dy;
        copy.dc = body.dc;
        copy.ds = body.ds;
        return copy;
    }
    void add(BodyPlace place, const SolverBody& from, const SolverBody& to) {
        if (place < 0) return;
        SolverBody& body = rows.bodies[static_cast<std::size_t>(place)];
        addTo(body.vx, to.vx - from.vx);
        addTo(body.vy, to.vy - from.vy);
        addTo(body.w, to.w - from.w);
    }
    static void addTo(float& sum, float change) {
        if (change == 0.0f) return;
        const std::atomic_ref<float> shared(sum);
        float seen = shared.load(std::memory_order_relaxed);
        while (!shared.compare_exchange_weak(seen, seen + change, std::memory_order_relaxed)) {
        }
    }
};

}  // namespace

void solveWithLocks(const BatchTask& task, const Team& team) {
    UnderLocks one{task.rows};
    KeyOrderSweeper<UnderLocks> sweeper(task, team, one);
    softStep(task, team, sweeper);
}

void solveWithAtomics(const BatchTask& task, const Team& team) {
    WithAtomics one{task.rows};
    KeyOrderSweeper<WithAtomics> sweeper(task, team, one);
    softStep(task, team, sweeper);
}

void fitLocks(MethodMemory& memory, const Plan& plan) {
    memory.locks.assign(plan.bodyOfPlace.size(), 0);
}

}  // namespace huestep
