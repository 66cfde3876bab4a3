#include <dspace/render/GpuStore.h>

#include "vtk_glew.h"

#include <dspace/Error.h>
#include <dspace/render/DrawList.h>
#include <dspace/render/shadows/CasterParts.h>

namespace dspace {
namespace {

// Interleaved: position 3 floats, normal 3, texture coordinate 2, colour 4 bytes.
struct Vertex {
  float position[3];
  float normal[3];
  float tcoord[2];
  std::uint8_t color[4];
};
static_assert(sizeof(Vertex) == 36, "tightly packed");

std::vector<Vertex> Interleave(const Mesh& mesh) {
  std::vector<Vertex> vertices(mesh.VertexCount());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    Vertex& v = vertices[i];
    for (int k = 0; k < 3; ++k) {
      v.position[k] = mesh.positions[3 * i + k];
      v.normal[k] = mesh.normals.empty() ? (k == 2 ? 1.0f : 0.0f) : mesh.normals[3 * i + k];
    }
    for (int k = 0; k < 2; ++k) {
      v.tcoord[k] = mesh.tcoords.empty() ? 0.0f : mesh.tcoords[2 * i + k];
    }
    for (int k = 0; k < 4; ++k) {
      v.color[k] = mesh.colors.empty() ? 255 : mesh.colors[4 * i + k];
    }
  }
  return vertices;
}

void Attribute(unsigned int location, int components, unsigned int type, bool normalized,
               std::size_t offset) {
  glEnableVertexAttribArray(location);
  // OpenGL takes the offset as a pointer.
  const auto* at = reinterpret_cast<const void*>(offset); // NOLINT(performance-no-int-to-ptr)
  glVertexAttribPointer(location, components, type, normalized ? GL_TRUE : GL_FALSE, sizeof(Vertex),
                        at);
}

// What advances with the instances; the buffer itself is bound when they are drawn.
void InstanceAttributes() {
  const auto floats = [](unsigned int location, int components, std::size_t offset) {
    glVertexAttribFormat(location, components, GL_FLOAT, GL_FALSE, static_cast<GLuint>(offset));
  };
  for (unsigned int row = 0; row < 3; ++row) {
    floats(4 + row, 4, offsetof(DrawInstance, viewFromMesh) + 4 * sizeof(float) * row);
  }
  floats(7, 4, offsetof(DrawInstance, color));
  floats(8, 2, offsetof(DrawInstance, metallic)); // and roughness after it
  glVertexAttribIFormat(9, 1, GL_UNSIGNED_INT, offsetof(DrawInstance, label));
  floats(10, 1, offsetof(DrawInstance, mirrored));
  floats(11, 3, offsetof(DrawInstance, emissive));
  for (unsigned int location = 4; location < 12; ++location) {
    glVertexAttribBinding(location, InstanceBinding);
    glEnableVertexAttribArray(location);
  }
  glVertexBindingDivisor(InstanceBinding, 1);
}

// Rows from the bottom up, as OpenGL wants them, with three or four channels.
std::vector<std::uint8_t> TextureBytes(const Image& image, int channels) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(static_cast<std::size_t>(image.width) * image.height * channels);
  for (int y = image.height - 1; y >= 0; --y) {
    const std::uint8_t* row =
        image.pixels.data() + static_cast<std::size_t>(y) * image.width * image.channels;
    for (int x = 0; x < image.width; ++x, row += image.channels) {
      const bool grey = image.channels < 3;
      for (int k = 0; k < 3; ++k) {
        bytes.push_back(row[grey ? 0 : k]);
      }
      if (channels == 4) {
        bytes.push_back(row[image.channels - 1]);
      }
    }
  }
  return bytes;
}

} // namespace

const GpuMesh& GpuStore::MeshOf(const std::shared_ptr<const Mesh>& mesh) {
  MeshEntry& entry = this->Meshes_[mesh.get()];
  if (entry.gpu.vertexArray && entry.mesh.lock() == mesh) {
    return entry.gpu;
  }
  this->Free(entry); // another mesh lived at this address
  entry.mesh = mesh;
  GpuMesh& gpu = entry.gpu;
  const std::vector<Vertex> vertices = Interleave(*mesh);
  glGenVertexArrays(1, &gpu.vertexArray);
  glBindVertexArray(gpu.vertexArray);
  glGenBuffers(1, &gpu.vertexBuffer);
  glBindBuffer(GL_ARRAY_BUFFER, gpu.vertexBuffer);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(Vertex)),
               vertices.data(), GL_STATIC_DRAW);
  glGenBuffers(1, &gpu.indexBuffer);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, gpu.indexBuffer);
  glBufferData(GL_ELEMENT_ARRAY_BUFFER,
               static_cast<GLsizeiptr>(mesh->indices.size() * sizeof(std::uint32_t)),
               mesh->indices.data(), GL_STATIC_DRAW);
  Attribute(0, 3, GL_FLOAT, false, offsetof(Vertex, position));
  Attribute(1, 3, GL_FLOAT, false, offsetof(Vertex, normal));
  Attribute(2, 2, GL_FLOAT, false, offsetof(Vertex, tcoord));
  Attribute(3, 4, GL_UNSIGNED_BYTE, true, offsetof(Vertex, color));
  InstanceAttributes();
  glBindVertexArray(0);
  glBindBuffer(GL_ARRAY_BUFFER, 0);
  gpu.mode = mesh->primitive == Mesh::Primitive::Triangles ? GL_TRIANGLES
             : mesh->primitive == Mesh::Primitive::Lines   ? GL_LINES
                                                           : GL_POINTS;
  gpu.indexCount = static_cast<int>(mesh->indices.size());
  gpu.hasColors = !mesh->colors.empty();
  for (const Vertex& vertex : vertices) {
    gpu.bounds.extend(Eigen::Map<const Eigen::Vector3f>(vertex.position));
  }
  gpu.parts = PartsOf(*mesh);
  gpu.bytes = vertices.size() * sizeof(Vertex) + mesh->indices.size() * sizeof(std::uint32_t);
  this->Statistics_.meshBytes += gpu.bytes;
  this->Statistics_.meshBytesUploaded += gpu.bytes;
  return gpu;
}

unsigned int GpuStore::TextureOf(const std::shared_ptr<const Image>& image, bool repeat,
                                 Values values) {
  const bool srgb = values == Values::Srgb;
  TextureEntry& entry = this->Textures_[(repeat ? 1 : 0) + (srgb ? 0 : 2)][image.get()];
  if (entry.texture && entry.image.lock() == image) {
    return entry.texture;
  }
  GLint limit = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &limit);
  if (image->width > limit || image->height > limit) {
    throw Error(Error::Kind::Resource, "texture '" + image->name + "'",
                "is " + std::to_string(image->width) + " x " + std::to_string(image->height) +
                    " pixels; this OpenGL takes at most " + std::to_string(limit) + " a side");
  }
  this->Free(entry);
  entry.image = image;
  const int channels = image->channels % 2 == 0 ? 4 : 3;
  const std::vector<std::uint8_t> bytes = TextureBytes(*image, channels);
  glGenTextures(1, &entry.texture);
  glBindTexture(GL_TEXTURE_2D, entry.texture);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  const GLint format =
      channels == 4 ? (srgb ? GL_SRGB8_ALPHA8 : GL_RGBA8) : (srgb ? GL_SRGB8 : GL_RGB8);
  glTexImage2D(GL_TEXTURE_2D, 0, format, image->width, image->height, 0,
               channels == 4 ? GL_RGBA : GL_RGB, GL_UNSIGNED_BYTE, bytes.data());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glGenerateMipmap(GL_TEXTURE_2D);
  const GLint wrap = repeat ? GL_REPEAT : GL_CLAMP_TO_EDGE;
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, wrap);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, wrap);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glBindTexture(GL_TEXTURE_2D, 0);
  entry.bytes = bytes.size();
  this->Statistics_.textureBytes += entry.bytes;
  this->Statistics_.textureBytesUploaded += entry.bytes;
  return entry.texture;
}

void GpuStore::Free(MeshEntry& entry) {
  if (entry.gpu.vertexArray) {
    glDeleteVertexArrays(1, &entry.gpu.vertexArray);
    glDeleteBuffers(1, &entry.gpu.vertexBuffer);
    glDeleteBuffers(1, &entry.gpu.indexBuffer);
    this->Statistics_.meshBytes -= entry.gpu.bytes;
  }
  entry.gpu = {};
}

void GpuStore::Free(TextureEntry& entry) {
  if (entry.texture) {
    glDeleteTextures(1, &entry.texture);
    this->Statistics_.textureBytes -= entry.bytes;
  }
  entry.texture = 0;
  entry.bytes = 0;
}

void GpuStore::Collect() {
  const auto sweep = [this](auto& map, const auto& gone) {
    for (auto it = map.begin(); it != map.end();) {
      if (gone(it->second)) {
        this->Free(it->second);
        it = map.erase(it);
      } else {
        ++it;
      }
    }
  };
  sweep(this->Meshes_, [](const MeshEntry& e) { return e.mesh.expired(); });
  for (auto& textures : this->Textures_) {
    sweep(textures, [](const TextureEntry& e) { return e.image.expired(); });
  }
}

void GpuStore::Release() {
  for (auto& entry : this->Meshes_) {
    this->Free(entry.second);
  }
  this->Meshes_.clear();
  for (auto& textures : this->Textures_) {
    for (auto& entry : textures) {
      this->Free(entry.second);
    }
    textures.clear();
  }
}

} // namespace dspace
