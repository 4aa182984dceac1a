#include "src/scene/surface_file.h"

#include "core/keyed_error.h"

#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <fmt/format.h>

#include <cmath>
#include <map>

namespace ligament::program
{
namespace
{
/// Numbers for places; those that round to the same point of a fine grid, or to neighbouring ones,
/// share theirs.
class Welder
{
public:
  explicit Welder(double tolerance) : tolerance_(tolerance) {}

  int number(const Vector<3> &x)
  {
    std::array<long, 3> k;
    for (int a = 0; a < 3; ++a)
      k[a] = std::lround(x[a] / tolerance_);
    for (long dx = -1; dx <= 1; ++dx)
      for (long dy = -1; dy <= 1; ++dy)
        for (long dz = -1; dz <= 1; ++dz)
          if (const auto found = numbers_.find({k[0] + dx, k[1] + dy, k[2] + dz});
              found != numbers_.end())
            return found->second;
    numbers_[k] = int(vertices.size());
    vertices.push_back(x);
    return int(vertices.size()) - 1;
  }

  std::vector<Vector<3>> vertices;

private:
  double tolerance_;
  std::map<std::array<long, 3>, int> numbers_;
};
} // namespace

void read_surface(const std::string &file, const std::string &key, std::vector<Vector<3>> &vertices,
                  std::vector<core::Solid<3>::Facet> &facets)
{
  Assimp::Importer importer;
  const aiScene *scene = importer.ReadFile(file, aiProcess_Triangulate);
  if (!scene || scene->mNumMeshes == 0)
    throw core::KeyedError(key, fmt::format("\"file\" {} cannot be read", file),
                           importer.GetErrorString(), "give an STL file of a closed surface");
  double extent = 0;
  for (unsigned m = 0; m < scene->mNumMeshes; ++m)
    for (unsigned v = 0; v < scene->mMeshes[m]->mNumVertices; ++v) {
      const aiVector3D &x = scene->mMeshes[m]->mVertices[v];
      extent =
          std::max({extent, std::abs(double(x.x)), std::abs(double(x.y)), std::abs(double(x.z))});
    }
  Welder welder(1e-7 * extent);
  for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
    const aiMesh &mesh = *scene->mMeshes[m];
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      if (mesh.mFaces[f].mNumIndices != 3)
        continue;
      std::array<int, 3> t;
      for (int k = 0; k < 3; ++k) {
        const aiVector3D &x = mesh.mVertices[mesh.mFaces[f].mIndices[k]];
        t[k] = welder.number(Vector<3>(x.x, x.y, x.z));
      }
      if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0])
        facets.push_back({{{t[0], t[1]}, {t[1], t[2]}, {t[2], t[0]}}, -1});
    }
  }
  vertices = std::move(welder.vertices);
}
} // namespace ligament::program
