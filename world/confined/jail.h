#pragma once

namespace skerry::world {

/// From here on this process can compute, take memory, and read and write what it has open, no
/// more. To open a file, make a socket or run a program ends it by SIGSYS; other system calls fail.
/// For processes that read files of strangers (child.h).
/// @return whether the system does that; not on processors other than x86-64 and AArch64, nor under
/// sanitizers, which open files themselves.
bool enter_jail();

}  // namespace skerry::world
