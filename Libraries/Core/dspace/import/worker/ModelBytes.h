// Models and images as bytes: internal, not installed.
#ifndef DSPACE_IMPORT_WORKER_MODEL_BYTES_H
#define DSPACE_IMPORT_WORKER_MODEL_BYTES_H

#include <memory>
#include <vector>

#include <dspace/import/model/Model.h>
#include <dspace/import/worker/Bytes.h>

namespace dspace {

// All of a model but Material::reflectance, which no file states. An image that several materials
// share is written once.
void WriteModel(const Model& model, ByteWriter& into);
void WriteImage(const Image& image, ByteWriter& into);
// Materials with their images.
void WriteMaterials(const std::vector<const Material*>& materials, ByteWriter& into);

// The model, whose path is `path`. It passes CheckModel, and images, lights and animations are
// consistent, whatever the bytes are. Throws Error(Corrupt).
Model ReadModelBytes(ByteReader& from, const std::string& path);
std::shared_ptr<const Image> ReadImageBytes(ByteReader& from);
// CheckModel still has to look at their numbers.
std::vector<Material> ReadMaterialBytes(ByteReader& from);

} // namespace dspace

#endif
