#include "corpus/outside_checker.h"

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "export/export_crack_surface.h"

namespace sherd::test {
namespace {

namespace fs = std::filesystem;

void writeSource(const fs::path& path, const TriMesh& mesh) {
  std::ofstream out(path);
  for (const Vec3& p : mesh.positions) {
    const Vec3 q = mesh.frame.toFile(p);
    out << fmt::format("v {:.17g} {:.17g} {:.17g}\n", q.x(), q.y(), q.z());
  }
  for (const Triangle& t : mesh.triangles) out << fmt::format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
}

std::string outputOf(const std::string& command) {
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return "";
  std::string text;
  char buffer[4096];
  while (const std::size_t n = fread(buffer, 1, sizeof buffer, pipe)) text.append(buffer, n);
  pclose(pipe);
  return text;
}

}  // namespace

OutsideChecker::OutsideChecker(fs::path scratch) : scratch_(std::move(scratch)) {
  const fs::path source = SHERD_SOURCE_DIR "/../shared/check/fragments.cpp";
  fs::create_directories(scratch_);
  if (!fs::exists(source)) {
    why_ = source.string() + " is absent";
    return;
  }
  const fs::path program = scratch_ / "fragments";
  if (fs::exists(program) && fs::last_write_time(program) > fs::last_write_time(source)) return;
  const std::string build =
      fmt::format("g++ -std=c++17 -O2 '{}' -o '{}' -lgmp -lmpfr", source.string(), program.string());
  if (std::system(build.c_str()) != 0) why_ = "'" + build + "' failed";
}

OutsideChecker::Verdict OutsideChecker::check(const Fragments& fragments) const {
  const fs::path pieces = scratch_ / "pieces", source = scratch_ / "source.obj",
                 list = scratch_ / "arguments";
  fs::remove_all(pieces);
  ExportCrackSurfaceParams params;
  params.directory = pieces.string();
  const auto exported = exportCrackSurface(fragments, params, Exec{});
  if (!exported.ok()) return {false, exported.error().text()};
  writeSource(source, *fragments.tets->surface);
  std::ofstream arguments(list);
  for (const Piece& piece : fragments.pieces) {
    arguments << piece.name << "_surface.obj";
    if (!piece.crack.empty()) arguments << "+" << piece.name << "_crack.obj";
    arguments << "\n";
  }
  arguments.close();
  const std::string line =
      outputOf(fmt::format("cd '{0}/pieces' && xargs -x -s 1000000 -a '{0}/arguments' '{0}/fragments' "
                           "'{0}/source.obj' --points 300 2>&1",
                           scratch_.string()));
  fs::remove_all(pieces);
  return {line.find("\"good\": true") != std::string::npos, line};
}

}  // namespace sherd::test
