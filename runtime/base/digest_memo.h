// Remembers the digests of shared, immutable values, so that a mesh that ten results hold is hashed once per
// process and not once per result.
#pragma once

#include <memory>

#include "base/hash.h"

namespace sherd {

struct ValueType;

/// type.digest(value.get()), computed once for each object that is alive; other threads that ask for the same
/// one meanwhile wait for it. What `value` points at must not change any more. Values of a few kilobytes are
/// hashed each time, which costs no more than looking them up. Cost O(1) from the second time on.
Digest sharedDigest(const ValueType& type, const std::shared_ptr<const void>& value);

/// Tells the digest of a value that was read from where it is kept under this digest, so that it need not be
/// computed.
void rememberDigest(const ValueType& type, const std::shared_ptr<const void>& value, const Digest& digest);

}  // namespace sherd
