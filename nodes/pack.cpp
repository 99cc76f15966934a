// The node pack: one loadable plugin that registers every step.
#include "plugin/plugin.h"

namespace sherd {

NodeType loadMeshNode();
NodeType loadPictureNode();
NodeType repairNode();
NodeType tetrahedralizeNode();
NodeType warpRestNode();
NodeType embedNode();
NodeType protectNode();
NodeType simulateNode();
NodeType readVdbNode();
NodeType paintBetaNode();
NodeType writeVdbNode();
NodeType weightsNode();
NodeType pinSitesNode();
NodeType trainDegreeNode();
NodeType writeModelNode();
NodeType readModelNode();
NodeType predictDegreeNode();
NodeType calibrateToughnessNode();
NodeType cvdNode();
NodeType tessellateNode();
NodeType selectPieceNode();
NodeType convexProxiesNode();
NodeType exportCrackSurfaceNode();
NodeType exportPiecesNode();
NodeType exportProxiesNode();
NodeType previewNode();
NodeType contactSheetNode();

}  // namespace sherd

SHERD_NODE_PACK(sherd::loadMeshNode, sherd::loadPictureNode, sherd::repairNode, sherd::tetrahedralizeNode,
                sherd::warpRestNode, sherd::embedNode, sherd::protectNode, sherd::simulateNode,
                sherd::readVdbNode, sherd::paintBetaNode, sherd::writeVdbNode, sherd::weightsNode,
                sherd::trainDegreeNode, sherd::writeModelNode, sherd::readModelNode, sherd::pinSitesNode,
                sherd::predictDegreeNode, sherd::calibrateToughnessNode, sherd::cvdNode,
                sherd::tessellateNode, sherd::selectPieceNode, sherd::convexProxiesNode,
                sherd::exportCrackSurfaceNode, sherd::exportPiecesNode, sherd::exportProxiesNode,
                sherd::previewNode, sherd::contactSheetNode)
