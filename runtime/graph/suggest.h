// "Did you mean": the known word that is closest to a misspelt one.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace sherd {

/// Edit distance with insertions, deletions, substitutions and swaps of neighbours (Damerau–Levenshtein,
/// optimal string alignment); a change of case costs nothing. O(|a| |b|).
std::size_t editDistance(std::string_view a, std::string_view b);

/// The closest of `known` that is within a third of the word's length (at least 1); else the first that has a
/// part in common with it: that begins with `word`, contains it, begins with what is within 2 changes of
/// it, or makes up at least half of it ("young" and "modulus" both find "youngs_modulus"). Else empty.
std::string closest(std::string_view word, const std::vector<std::string>& known);

/// What to say instead of `word`: 'did you mean "x"?', else a listing(). `kind` names the words in the
/// plural: "parameters"; `command` is a command line that prints all of them, where there is one.
std::string suggestion(std::string_view word, const std::vector<std::string>& known, std::string_view kind,
                       std::string_view command = {});

/// What the words are: all of them if they are few, else the command that lists them, else the first ones and
/// how many more there are. Never empty.
std::string listing(const std::vector<std::string>& known, std::string_view kind,
                    std::string_view command = {});

/// The words in quotation marks, separated by commas.
std::string quotedList(const std::vector<std::string>& words);
/// The text in quotation marks, shortened to `longest` bytes, control characters made visible.
std::string inQuotes(std::string_view text, std::size_t longest = 60);

}  // namespace sherd
