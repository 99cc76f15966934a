// Aligned columns of text.
#pragma once

#include <ostream>
#include <string>
#include <vector>

namespace sherd {

using Row = std::vector<std::string>;

/// Prints the rows two spaces in, their columns aligned by characters (not bytes) and two spaces apart. All
/// rows have as many cells, at least one. The last column is wrapped at `width` characters, or at 30 of its
/// own where `width` leaves less.
void printTable(const std::vector<Row>& rows, int width, std::ostream& out);

}  // namespace sherd
