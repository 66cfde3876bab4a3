#include <dspace/import/gltf/GltfAccessor.h>

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace dspace {

namespace {

std::size_t SizeOfComponent(int componentType) {
  switch (componentType) {
  case 5120: // BYTE
  case 5121: // UNSIGNED_BYTE
    return 1;
  case 5122: // SHORT
  case 5123: // UNSIGNED_SHORT
    return 2;
  case 5125: // UNSIGNED_INT
  case GltfAccessor::Float:
    return 4;
  default:
    return 0;
  }
}

template<typename T> double Load(const char* p) {
  T value;
  std::memcpy(&value, p, sizeof value); // files need not be aligned
  return static_cast<double>(value);
}

// Value of one component; normalised integers by section 3.11.
double LoadComponent(const char* p, int componentType, bool normalized) {
  switch (componentType) {
  case 5120: {
    const double v = Load<std::int8_t>(p);
    return normalized ? std::max(v / 127.0, -1.0) : v;
  }
  case 5121: {
    const double v = Load<std::uint8_t>(p);
    return normalized ? v / 255.0 : v;
  }
  case 5122: {
    const double v = Load<std::int16_t>(p);
    return normalized ? std::max(v / 32767.0, -1.0) : v;
  }
  case 5123: {
    const double v = Load<std::uint16_t>(p);
    return normalized ? v / 65535.0 : v;
  }
  case 5125:
    return Load<std::uint32_t>(p);
  default:
    return Load<float>(p);
  }
}

// The bytes that `count` elements of `size` bytes take, `stride` apart, from `offset` of a view.
const char* CheckRange(const GltfDocument& document, const GltfDocument::View& view,
                       std::size_t offset, std::size_t count, std::size_t size, std::size_t stride,
                       const std::string& where) {
  if (count == 0 || offset + (count - 1) * stride + size > view.length) {
    document.Fail(where + " needs " + std::to_string(count) + " elements of " +
                  std::to_string(size) + " bytes from byte " + std::to_string(offset) +
                  " of a buffer view of " + std::to_string(view.length) + " bytes");
  }
  return view.data + offset;
}

struct Sparse {
  std::size_t count = 0;
  const char* indices = nullptr;
  int indexType = 0;
  const char* values = nullptr;
};

Sparse CheckSparse(const GltfDocument& document, const GltfAccessor& accessor) {
  const std::string where = "accessors[" + std::to_string(accessor.index) + "].sparse";
  const Json::Value& json = document.Element("accessors", accessor.index)["sparse"];
  if (!json.isObject() || !json["indices"].isObject() || !json["values"].isObject()) {
    document.Fail(where + " has no indices and values");
  }
  Sparse sparse;
  sparse.count = document.Count(json, "count", 0, where);
  if (sparse.count == 0 || sparse.count > accessor.count) {
    document.Fail(where + ".count is " + std::to_string(sparse.count) + " of " +
                  std::to_string(accessor.count));
  }
  const Json::Value& indices = json["indices"];
  sparse.indexType = static_cast<int>(document.Count(indices, "componentType", 0, where));
  if (sparse.indexType != 5121 && sparse.indexType != 5123 && sparse.indexType != 5125) {
    document.Fail(where + ".indices.componentType is " + std::to_string(sparse.indexType));
  }
  const std::size_t indexSize = SizeOfComponent(sparse.indexType);
  sparse.indices = CheckRange(
      document, document.BufferView(document.Index(indices, "bufferView", "bufferViews", where)),
      document.Count(indices, "byteOffset", 0, where), sparse.count, indexSize, indexSize, where);
  const Json::Value& values = json["values"];
  const std::size_t size = accessor.ComponentSize() * accessor.components;
  sparse.values = CheckRange(
      document, document.BufferView(document.Index(values, "bufferView", "bufferViews", where)),
      document.Count(values, "byteOffset", 0, where), sparse.count, size, size, where);
  for (std::size_t i = 0; i < sparse.count; ++i) {
    const double index = LoadComponent(sparse.indices + i * indexSize, sparse.indexType, false);
    if (index >= static_cast<double>(accessor.count)) {
      document.Fail(where + " sets element " + std::to_string(std::size_t(index)) + " of " +
                    std::to_string(accessor.count));
    }
  }
  return sparse;
}

} // namespace

std::size_t GltfAccessor::ComponentSize() const {
  return SizeOfComponent(this->componentType);
}

GltfAccessor CheckGltfAccessor(const GltfDocument& document, std::size_t index,
                               std::size_t maximumCount) {
  const std::string where = "accessors[" + std::to_string(index) + "]";
  const Json::Value& json = document.Element("accessors", index);
  GltfAccessor accessor;
  accessor.index = index;
  accessor.componentType = static_cast<int>(document.Count(json, "componentType", 0, where));
  accessor.type = json["type"].isString() ? json["type"].asString() : "";
  accessor.components = accessor.type == "SCALAR" ? 1
                        : accessor.type == "VEC2" ? 2
                        : accessor.type == "VEC3" ? 3
                        : accessor.type == "VEC4" ? 4
                                                  : 0;
  if (accessor.ComponentSize() == 0 || accessor.components == 0) {
    document.Fail(where + " has component type " + std::to_string(accessor.componentType) +
                  " and type '" + accessor.type + "'; 5120 to 5126 and SCALAR to VEC4 are read");
  }
  accessor.count = document.Count(json, "count", 0, where);
  if (accessor.count == 0) {
    document.Fail(where + ".count is 0");
  }
  if (accessor.count > maximumCount) {
    document.Fail(where + ".count is " + std::to_string(accessor.count) + "; at most " +
                      std::to_string(maximumCount) + " are accepted",
                  Error::Kind::Resource);
  }
  accessor.normalized = json["normalized"].isBool() && json["normalized"].asBool();
  accessor.hasView = !json["bufferView"].isNull();
  if (accessor.hasView) {
    const GltfDocument::View view =
        document.BufferView(document.Index(json, "bufferView", "bufferViews", where));
    const std::size_t size = accessor.ComponentSize() * accessor.components;
    CheckRange(document, view, document.Count(json, "byteOffset", 0, where), accessor.count, size,
               view.stride != 0 ? view.stride : size, where);
  }
  accessor.sparse = !json["sparse"].isNull();
  if (accessor.sparse) {
    CheckSparse(document, accessor);
  }
  return accessor;
}

std::vector<float> GltfAccessorFloats(const GltfDocument& document, const GltfAccessor& accessor,
                                      std::size_t components, float fill) {
  const Json::Value& json = document.Element("accessors", accessor.index);
  const std::size_t used = std::min(components, accessor.components);
  const std::size_t step = accessor.ComponentSize();
  const std::size_t size = step * accessor.components;
  std::vector<float> out(accessor.count * components, 0.0f);
  const auto set = [&](std::size_t element, const char* p) {
    for (std::size_t k = 0; k < used; ++k) {
      out[element * components + k] = static_cast<float>(
          LoadComponent(p + k * step, accessor.componentType, accessor.normalized));
    }
  };
  for (std::size_t i = 0; i < accessor.count; ++i) {
    for (std::size_t k = used; k < components; ++k) {
      out[i * components + k] = fill;
    }
  }
  if (accessor.hasView) {
    const GltfDocument::View view =
        document.BufferView(document.Index(json, "bufferView", "bufferViews", "accessor"));
    const char* p = view.data + document.Count(json, "byteOffset", 0, "accessor");
    for (std::size_t i = 0; i < accessor.count; ++i) {
      set(i, p + i * (view.stride != 0 ? view.stride : size));
    }
  }
  if (accessor.sparse) {
    const Sparse sparse = CheckSparse(document, accessor);
    const std::size_t indexSize = SizeOfComponent(sparse.indexType);
    for (std::size_t i = 0; i < sparse.count; ++i) {
      set(static_cast<std::size_t>(
              LoadComponent(sparse.indices + i * indexSize, sparse.indexType, false)),
          sparse.values + i * size);
    }
  }
  return out;
}

std::uint32_t GltfAccessorMaximum(const GltfDocument& document, const GltfAccessor& accessor) {
  const Json::Value& json = document.Element("accessors", accessor.index);
  const GltfDocument::View view =
      document.BufferView(document.Index(json, "bufferView", "bufferViews", "accessor"));
  const char* p = view.data + document.Count(json, "byteOffset", 0, "accessor");
  const std::size_t step = view.stride != 0 ? view.stride : accessor.ComponentSize();
  double largest = 0.0; // holds every 32-bit integer
  for (std::size_t i = 0; i < accessor.count; ++i) {
    largest = std::max(largest, LoadComponent(p + i * step, accessor.componentType, false));
  }
  if (accessor.sparse) {
    const Sparse sparse = CheckSparse(document, accessor);
    for (std::size_t i = 0; i < sparse.count; ++i) {
      largest = std::max(largest, LoadComponent(sparse.values + i * accessor.ComponentSize(),
                                                accessor.componentType, false));
    }
  }
  return static_cast<std::uint32_t>(largest);
}

} // namespace dspace
