// What changed between two texts, by lines.
#pragma once

#include <string>
#include <string_view>

namespace sherd {

/// The changes from `before` to `after` as a unified diff with three lines of context, both sides called
/// `name`; empty where the texts are equal. O(changed lines before × changed lines after) up to a few million
/// of these, beyond which the changed part is shown as replaced in one.
std::string unifiedDiff(std::string_view before, std::string_view after, const std::string& name);

}  // namespace sherd
