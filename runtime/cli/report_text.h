// Texts as the report shows them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace sherd {

/// For HTML and SVG, in text and in attributes.
std::string htmlEscaped(std::string_view text);
/// "0 B", "999 B", "1.2 kB", "34 MB", in powers of ten.
std::string byteText(std::uint64_t bytes);
std::string base64(std::string_view bytes);

/// Characters of UTF-8 text; wide ones (Chinese, Japanese, Korean, pictographs) count twice.
int shownLength(std::string_view text);
/// About how wide `text` is in a plain sans-serif font, in units of its size; a little more rather than less.
double widthInEms(std::string_view text);
/// `text` with at most about `most` characters: a longer one loses its middle to "…".
std::string elided(const std::string& text, int most);

}  // namespace sherd
