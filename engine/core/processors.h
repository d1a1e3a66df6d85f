#pragma once

namespace skerry {

/// How many processors this process may use: those of its affinity, which Slurm and taskset set.
/// @return 1..
int usable_cpus();

}  // namespace skerry
