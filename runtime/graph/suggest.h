// "Did you mean": the known word that is closest to a misspelt one.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace sherd {

/// Edit distance with insertions, deletions, substitutions and swaps of neighbours (Damerau–Levenshtein,
/// optimal string alignment); a change of case costs nothing. O(|a| |b|).
std::size_t editDistance(std::string_view a, std::string_view b);

/// The closest of `known` that is within a third of the word's length (at least 1), or empty.
std::string closest(std::string_view word, const std::vector<std::string>& known);

/// What to say instead of `word`: 'did you mean "x"?', else the known words if they are few, else nothing.
/// `kind` names them in the plural: "parameters".
std::string suggestion(std::string_view word, const std::vector<std::string>& known, std::string_view kind);

/// The words in quotation marks, separated by commas.
std::string quotedList(const std::vector<std::string>& words);
/// The text in quotation marks, shortened to 60 characters, control characters made visible.
std::string inQuotes(std::string_view text);

}  // namespace sherd
