/// The other benchmarks of `bench`: what going back costs, and how cost grows with the world.
#pragma once

#include <vector>

#include "tools/command.h"

namespace huestep::tools {

/// `bench --rollback`: checkpoints, rollbacks of eight ticks, snapshots and hashes at three sizes,
/// on one thread. The hashes of every tick that was stepped again must be those of the first time;
/// otherwise no time is printed and it differs.
Answer benchRollback(int repeats, bool json);

/// `bench --scale`: time a body and tick and bytes a body of growing worlds, for each number of
/// threads. `quick`: up to 1,000 bodies, as a smoke test. The hashes of all numbers of threads must
/// agree.
Answer benchScale(const std::vector<int>& threads, bool quick, bool json);

}  // namespace huestep::tools
