// Files that are read along with one that names them: an OBJ's material library, a glTF's buffers and
// pictures. A result that was made from the one depends on the others' content, too.
#pragma once

#include <string>
#include <vector>

namespace sherd {

/// The paths of all files that reading `path` may read as well, whether they are there or not. Must not
/// throw, and finds them again each time: what `path` says may have changed.
using CompanionFinder = std::vector<std::string> (*)(const std::string& path);

/// Files whose names end so (".obj", in lower case) are read with these; said by the pack that reads them.
/// The last one to say so counts. Thread-safe.
void setCompanionFiles(const std::string& extension, CompanionFinder finder);

/// By the ending of `path` in whatever case; empty where nothing was said.
std::vector<std::string> companionFiles(const std::string& path);

}  // namespace sherd
