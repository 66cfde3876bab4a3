#include <dspace/render/text/TextShapes.h>

#include <map>

#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkStdString.h"
#include "vtkTextProperty.h"
#include "vtkTextRenderer.h"

#include <dspace/Checks.h>
#include <dspace/Error.h>
#include <dspace/letters/OutlineFont.h>
#include <dspace/overlay/TextCharacters.h>
#include <dspace/overlay/TextLimits.h>
#include <dspace/render/text/Fonts.h>
#include <dspace/render/text/OverlayText.h>

namespace dspace {
namespace {

void RequireText(const std::string& object, const std::string& text) {
  if (text.find_first_not_of(" \t\n") == std::string::npos) {
    Reject(object, "is empty; at least one visible character is needed");
  }
  RequireTextLength(object, "it", text);
  RequirePlainText(object, "it", text, true);
}

} // namespace

Mesh MakeTextMesh(const std::string& text, double height) {
  const std::string object = "text " + QuotedText(text);
  RequireText(object, text);
  RequireLength(object, "height", height);
  RequireGlyphs(object, "it", text, Font::Sans);
  OutlineFont font(Font::Sans);
  std::map<char32_t, OutlineFont::Letter> letters;
  Mesh mesh;
  mesh.name = text;
  double x = 0.0;
  double y = 0.0;
  for (const char32_t character : Characters(object, "it", text)) {
    if (character == U'\n') {
      x = 0.0;
      y -= font.LineHeight();
      continue;
    }
    const auto known = letters.find(character);
    const OutlineFont::Letter& letter =
        known != letters.end() ? known->second : letters[character] = font.Read(character);
    const auto first = static_cast<std::uint32_t>(mesh.VertexCount());
    for (const Eigen::Vector2d& p : letter.area.points) {
      mesh.positions.insert(mesh.positions.end(),
                            {float((x + p.x()) * height), float((y + p.y()) * height), 0.0f});
      mesh.normals.insert(mesh.normals.end(), {0.0f, 0.0f, 1.0f});
    }
    for (const std::uint32_t index : letter.area.triangles) {
      mesh.indices.push_back(first + index);
    }
    x += letter.advance;
  }
  if (mesh.indices.empty()) {
    Reject(object, "is blank; at least one visible character is needed");
  }
  return mesh;
}

Part MakeLabel(const std::string& text, const LabelStyle& style) {
  const std::string object = "label " + QuotedText(text);
  RequireText(object, text);
  RequireGlyphs(object, "it", text, Font::Sans);
  if (style.fontSize < 4 || style.fontSize > 200) {
    Reject(object, "font size " + std::to_string(style.fontSize) +
                       " is rejected; accepted: 4 to 200 pixels");
  }
  vtkNew<vtkTextProperty> look;
  UseFont(look, Font::Sans);
  look->SetFontSize(style.fontSize);
  look->SetColor(style.color[0], style.color[1], style.color[2]);
  look->SetBackgroundColor(style.background[0], style.background[1], style.background[2]);
  look->SetBackgroundOpacity(style.backgroundOpacity);
  int box[4] = {0, -1, 0, -1};
  const auto lock = LockTextRenderer();
  vtkTextRenderer::GetInstance()->GetBoundingBox(look, vtkStdString(text), box, 72,
                                                 vtkTextRenderer::FreeType);
  RequireTextPicture(object, box[1] - box[0] + 1.0, box[3] - box[2] + 1.0);
  vtkNew<vtkImageData> picture;
  int size[2] = {0, 0};
  // 72 dots an inch: font sizes are pixels. (vtkFreeTypeTools itself leaves out what is not ASCII.)
  if (!vtkTextRenderer::GetInstance()->RenderString(look, vtkStdString(text), picture, size, 72,
                                                    vtkTextRenderer::FreeType) ||
      size[0] < 1 || size[1] < 1 || picture->GetNumberOfScalarComponents() != 4) {
    throw Error(Error::Kind::Internal, object, "could not be drawn");
  }
  const int* extent = picture->GetExtent();
  const int stored[2] = {extent[1] - extent[0] + 1, extent[3] - extent[2] + 1};
  auto image = std::make_shared<Image>(); // only the part that was drawn, without padding
  image->name = "label '" + text + "'";
  image->width = std::min(size[0], stored[0]);
  image->height = std::min(size[1], stored[1]);
  image->channels = 4;
  image->pixels.reserve(static_cast<std::size_t>(image->width) * image->height * 4);
  for (int y = image->height - 1; y >= 0; --y) { // VTK's rows go up
    const auto* row = static_cast<const std::uint8_t*>(
        picture->GetScalarPointer(extent[0], extent[2] + y, extent[4]));
    image->pixels.insert(image->pixels.end(), row, row + std::size_t(4) * image->width);
  }

  auto mesh = std::make_shared<Mesh>();
  mesh->name = image->name;
  const auto left = static_cast<float>(style.offset[0]);
  const auto bottom = static_cast<float>(style.offset[1]);
  const float right = left + static_cast<float>(image->width);
  const float top = bottom + static_cast<float>(image->height);
  mesh->positions = {left, bottom, 0, right, bottom, 0, right, top, 0, left, top, 0};
  mesh->normals = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
  mesh->tcoords = {0, 0, 1, 0, 1, 1, 0, 1};
  mesh->indices = {0, 1, 2, 0, 2, 3};
  auto material = std::make_shared<Material>();
  material->name = image->name;
  material->color = {1, 1, 1};
  material->texture = image;
  material->repeatTexture = false;
  material->lit = false;
  return {mesh, material, Eigen::Affine3d::Identity()};
}

} // namespace dspace
