#include "export/pieces_json.h"

#include <nlohmann/json.hpp>

namespace sherd {
namespace {

using Json = nlohmann::ordered_json;

Json vector(const Vec3& v) { return Json::array({v.x(), v.y(), v.z()}); }

/// The bonds of piece p, seen from it.
Json neighbours(const Fragments& f, std::size_t p, const std::vector<Bond>& own) {
  Json list = Json::array();
  for (const Bond& bond : own) {
    const bool isLow = at(bond.low) == p;
    list.push_back({{"name", f.pieces[at(isLow ? bond.high : bond.low)].name},
                    {"contact_area", bond.area},
                    {"centroid", vector(bond.centroid)},
                    {"normal", vector(isLow ? bond.normal : Vec3(-bond.normal))}});
  }
  return list;
}

void addProperties(Json& json, const Fragments& f, std::size_t p, const std::vector<Bond>& own) {
  const Piece& piece = f.pieces[p];
  json["cell"] = piece.cell;
  json["mass"] = f.material.density * piece.volume;
  json["volume"] = piece.volume;
  json["centre_of_mass"] = vector(piece.centreOfMass);
  json["inertia"] =
      Json::array({vector(piece.inertia.row(0)), vector(piece.inertia.row(1)), vector(piece.inertia.row(2))});
  json["neighbours"] = neighbours(f, p, own);
}

Json describePiece(const Fragments& f, std::size_t p, const std::vector<Bond>& own,
                   const PieceFileNames& names) {
  Json json;
  json["name"] = f.pieces[p].name;
  json["surface"] = names.surface;
  json["crack"] = names.crack.empty() ? Json(nullptr) : Json(names.crack);
  addProperties(json, f, p, own);
  const std::string& parent = f.tets->surface->piece;
  json["parent"] = parent.empty() ? Json(nullptr) : Json(parent);
  json["birth_frame"] = nullptr;
  return json;
}

Json describeBonds(const Fragments& f, const std::vector<Bond>& bonds) {
  Json list = Json::array();
  for (const Bond& bond : bonds)
    list.push_back({{"pieces", Json::array({f.pieces[at(bond.low)].name, f.pieces[at(bond.high)].name})},
                    {"contact_area", bond.area},
                    {"centroid", vector(bond.centroid)},
                    {"normal", vector(bond.normal)}});
  return list;
}

}  // namespace

std::string pieceProperties(const Fragments& f, std::size_t piece, const std::vector<Bond>& own) {
  Json json;
  addProperties(json, f, piece, own);
  json["parent"] =
      f.tets->surface->piece;  // "" for none: extras that become properties of objects have no null
  return json.dump();
}

std::string piecesJson(const Fragments& f, const std::vector<Bond>& bonds,
                       const std::vector<PieceFileNames>& files) {
  const FileFrame& frame = f.tets->surface->frame;
  Json json;
  json["format"] = 1;
  json["about"] =
      "Pieces of a fracture. mass kg, volume m^3, centre_of_mass m, inertia kg m^2 about the centre of mass, "
      "contact_area m^2, E_D and gamma J m^2; N cells were made, and merged_parts of them (or "
      "parts of them) joined a neighbour, since they were below min_volume; where degree_given, N was asked "
      "for whatever gamma, and below_threshold, which tells whether E_D is below gamma, is null; "
      "right-handed axes, y up. A bond is where two pieces touch: its "
      "centroid in m, its normal the mean over the contact from the first piece to the second (for a "
      "neighbour: "
      "from the piece to it). Coordinates in the piece files are in the source file's own unit and axes, as "
      "files_frame tells.";
  json["files_frame"] = {{"metres_per_unit", frame.metresPerUnit},
                         {"up", frame.up == FileFrame::Up::Y ? "y" : "z"}};
  json["density"] = f.material.density;
  json["N"] = f.sites;
  json["E_D"] = f.energy;
  // Cells whose number was asked for may come from no γ at all.
  json["gamma"] = f.degreeGiven && f.gamma == 0 ? Json(nullptr) : Json(f.gamma);
  json["degree_given"] = f.degreeGiven;
  json["below_threshold"] = f.degreeGiven ? Json(nullptr) : Json(f.energy < f.gamma);
  json["piece_count"] = f.pieces.size();
  json["merged_parts"] = f.counts.mergedParts;
  json["pieces"] = Json::array();
  const std::vector<std::vector<Bond>> own = bondsByPiece(bonds, f.pieces.size());
  for (std::size_t p = 0; p < f.pieces.size(); ++p)
    json["pieces"].push_back(describePiece(f, p, own[p], files[p]));
  json["bonds"] = describeBonds(f, bonds);
  return json.dump(1) + "\n";
}

}  // namespace sherd
