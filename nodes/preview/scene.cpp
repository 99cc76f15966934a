#include "preview/scene.h"

#include <embree3/rtcore.h>

#include <limits>
#include <numeric>

namespace sherd {

struct Scene::Impl {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  Soup soup;

  Impl() = default;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }
};

namespace {

RTCRay rayFrom(const Vec3f& origin, const Vec3f& direction, float reach) {
  RTCRay ray{};
  ray.org_x = origin.x(), ray.org_y = origin.y(), ray.org_z = origin.z();
  ray.dir_x = direction.x(), ray.dir_y = direction.y(), ray.dir_z = direction.z();
  ray.tnear = 0;
  ray.tfar = reach;
  ray.mask = ~0u;
  return ray;
}

/// What Embree asks while it builds a scene; false ends that.
bool goOn(void* exec, double /*share*/) { return !static_cast<const Exec*>(exec)->cancelled(); }

template <class T>
T interpolate(const std::vector<T>& perCorner, std::size_t triangle, float u, float v) {
  const T* first = perCorner.data() + 3 * triangle;
  return (1 - u - v) * first[0] + u * first[1] + v * first[2];
}

}  // namespace

Scene::Scene(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Scene::~Scene() = default;
Scene::Scene(Scene&&) noexcept = default;
const Soup& Scene::soup() const { return impl_->soup; }

Result<Scene> Scene::make(Soup soup, const Exec& exec) {
  if (exec.cancelled()) return cancelledError();
  auto impl = std::make_unique<Impl>();
  impl->soup = std::move(soup);
  impl->device = rtcNewDevice("threads=1,set_affinity=0");
  if (impl->device == nullptr) return failure("Embree, which traces the picture's rays, cannot be started");
  impl->scene = rtcNewScene(impl->device);
  rtcSetSceneFlags(impl->scene, RTC_SCENE_FLAG_ROBUST);
  const RTCGeometry geometry = rtcNewGeometry(impl->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  const std::size_t corners = impl->soup.corners.size();
  auto* points = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                             RTC_FORMAT_FLOAT3, 3 * sizeof(float), corners));
  auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), corners / 3));
  if (corners > 0 && points != nullptr && indices != nullptr) {
    for (std::size_t i = 0; i < corners; ++i) Eigen::Map<Vec3f>(points + 3 * i) = impl->soup.corners[i];
    std::iota(indices, indices + corners, 0u);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(impl->scene, geometry);
  }
  rtcReleaseGeometry(geometry);
  rtcSetSceneProgressMonitorFunction(impl->scene, &goOn, const_cast<Exec*>(&exec));
  rtcCommitScene(impl->scene);
  rtcSetSceneProgressMonitorFunction(impl->scene, nullptr, nullptr);
  if (exec.cancelled()) return cancelledError();
  if (rtcGetDeviceError(impl->device) != RTC_ERROR_NONE)
    return failure("Embree, which traces the picture's rays, cannot hold the scene",
                   "there may be too little memory");
  return Scene(std::move(impl));
}

bool Scene::firstHit(const Vec3f& origin, const Vec3f& direction, Hit& hit) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit query{};
  query.ray = rayFrom(origin, direction, std::numeric_limits<float>::infinity());
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(impl_->scene, &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
  const Soup& soup = impl_->soup;
  const std::size_t triangle = query.hit.primID;
  hit.distance = query.ray.tfar;
  hit.geometricNormal = Vec3f(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z).normalized();
  if (hit.geometricNormal.dot(direction) > 0) hit.geometricNormal = -hit.geometricNormal;
  hit.normal = interpolate(soup.normals, triangle, query.hit.u, query.hit.v).normalized();
  // A shading normal must not face away from the viewer or from its own triangle.
  if (!(hit.normal.dot(hit.geometricNormal) > 0.05f)) hit.normal = hit.geometricNormal;
  hit.colour = soup.values.empty()
                   ? soup.palette[at(soup.paint[triangle])]
                   : energyColour(interpolate(soup.values, triangle, query.hit.u, query.hit.v));
  return true;
}

bool Scene::occluded(const Vec3f& origin, const Vec3f& direction, float reach) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRay ray = rayFrom(origin, direction, reach);
  rtcOccluded1(impl_->scene, &context, &ray);
  return ray.tfar < 0;
}

}  // namespace sherd
