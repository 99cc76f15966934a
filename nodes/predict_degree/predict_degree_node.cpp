#include "graph/node_type.h"
#include "predict_degree/predict_degree.h"

namespace sherd {

NodeType predictDegreeNode() {
  return NodeBuilder<PredictDegreeParams>(
             "PredictDegree", 1, "Decides from the energy into how many pieces the body breaks, and where.")
      .input<WeightField>("weights", "what each node weighs, from Weights")
      .input<Embedding>("embedding", "the distances to measure with, from Embed")
      .optionalInput<Sites>("pinned",
                            "sites that stay where they are, from PinSites; they count among the pieces")
      .optionalInput<DegreeModel>("model",
                                  "what was learned of this body, from TrainDegree; left open: searches")
      .number(
          "gamma", &PredictDegreeParams::gamma,
          {.unit = "J·m²",
           .min = 0,
           .help =
               "threshold γ: sites are added until E_D falls below it. Higher: tougher, fewer pieces; E_D "
               "falls about as N^(-2/3), so a tenth of γ gives some thirty times as many. May be wired to "
               "CalibrateToughness.gamma"})
      .integer("degree", &PredictDegreeParams::degree,
               {.unit = "", .min = 0, .max = 1e6, .help = "number of sites whatever γ; 0: from the energy"})
      .integer("seed", &PredictDegreeParams::seed, {.unit = "", .help = "another seed gives other sites"})
      .integer(
          "max_degree", &PredictDegreeParams::maxDegree,
          {.unit = "", .min = 1, .max = 1e6, .help = "the search by γ ends at so many sites, with a warning"})
      .choice("by", &PredictDegreeParams::by, {{"model", DegreeBy::Model}, {"search", DegreeBy::Search}},
              "with a model, what finds the number; search: as without one, to compare the two")
      .choice("outside", &PredictDegreeParams::outside,
              {{"search", OutsideModel::Search}, {"predict", OutsideModel::Predict}},
              "with a model, what to do with a hit unlike all that it was made of")
      .choice("other_body", &PredictDegreeParams::otherBody,
              {{"search", OtherBody::Search}, {"refuse", OtherBody::Refuse}},
              "with a model, what to do with a body that it wasn't made for, such as a fragment; what else "
              "differs for the same body (γ, α, β, material, embedding) is refused in any case")
      .output<std::int64_t>("degree", "number of sites N; 1: it does not break")
      .output<Sites>("sites", "the sites, with E_D and γ")
      .output<double>("energy", "E_D of these sites, J·m²")
      .implementation(6)
      .run([](const PredictDegreeParams& params, NodeIo& io) -> Result<void> {
        const auto weights = io.in<WeightField>("weights");
        const auto embedding = io.in<Embedding>("embedding");
        const auto model = io.in<DegreeModel>("model");
        const auto pinned = io.in<Sites>("pinned");
        SHERD_ASSIGN(Sites sites,
                     model ? predictByModel(*model, *weights, embedding, params, io.exec(), pinned.get())
                           : predictDegree(*weights, *embedding, pinned.get(), params, io.exec()));
        io.out("degree", static_cast<std::int64_t>(sites.positions.cols()));
        io.out("energy", sites.energy);
        io.out("sites", std::move(sites));
        return {};
      });
}

}  // namespace sherd
