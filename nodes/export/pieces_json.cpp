#include "export/pieces_json.h"

#include <map>
#include <nlohmann/json.hpp>

namespace sherd {
namespace {

using Json = nlohmann::ordered_json;

Json vector(const Vec3& v) { return Json::array({v.x(), v.y(), v.z()}); }

/// Contact area per neighbour, m², ascending by neighbour.
std::map<Index, double> contactAreas(const Fragments& f, const Piece& piece) {
  std::map<Index, double> areas;
  for (std::size_t t = 0; t < piece.crack.size(); ++t) {
    const Triangle& corners = piece.crack[t];
    const Vec3& a = f.positions[at(corners[0])];
    areas[piece.crackNeighbour[t]] +=
        0.5 * (f.positions[at(corners[1])] - a).cross(f.positions[at(corners[2])] - a).norm();
  }
  return areas;
}

Json describePiece(const Fragments& f, const Piece& piece, const PieceFileNames& names) {
  Json json;
  json["name"] = piece.name;
  json["surface"] = names.surface;
  json["crack"] = names.crack.empty() ? Json(nullptr) : Json(names.crack);
  json["cell"] = piece.cell;
  json["mass"] = f.material.density * piece.volume;
  json["volume"] = piece.volume;
  json["centre_of_mass"] = vector(piece.centreOfMass);
  json["inertia"] =
      Json::array({vector(piece.inertia.row(0)), vector(piece.inertia.row(1)), vector(piece.inertia.row(2))});
  json["neighbours"] = Json::array();
  for (const auto& [neighbour, area] : contactAreas(f, piece))
    json["neighbours"].push_back({{"name", f.pieces[at(neighbour)].name}, {"contact_area", area}});
  const std::string& parent = f.tets->surface->piece;
  json["parent"] = parent.empty() ? Json(nullptr) : Json(parent);
  json["birth_frame"] = nullptr;
  return json;
}

}  // namespace

std::string piecesJson(const Fragments& f, const std::vector<PieceFileNames>& files) {
  const FileFrame& frame = f.tets->surface->frame;
  Json json;
  json["format"] = 1;
  json["about"] =
      "Pieces of a fracture. mass kg, volume m^3, centre_of_mass m, inertia kg m^2 about the centre of mass, "
      "contact_area m^2, E_D and gamma J m^2; right-handed axes, y up. Coordinates in the piece files are in "
      "the "
      "source file's own unit and axes, as files_frame tells.";
  json["files_frame"] = {{"metres_per_unit", frame.metresPerUnit},
                         {"up", frame.up == FileFrame::Up::Y ? "y" : "z"}};
  json["density"] = f.material.density;
  json["N"] = f.sites;
  json["E_D"] = f.energy;
  json["gamma"] = f.gamma;
  json["degree_given"] = f.degreeGiven;
  json["below_threshold"] = !f.degreeGiven && f.energy < f.gamma;
  json["piece_count"] = f.pieces.size();
  json["pieces"] = Json::array();
  for (std::size_t p = 0; p < f.pieces.size(); ++p)
    json["pieces"].push_back(describePiece(f, f.pieces[p], files[p]));
  return json.dump(1) + "\n";
}

}  // namespace sherd
