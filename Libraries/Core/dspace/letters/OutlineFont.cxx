#include <dspace/letters/OutlineFont.h>

#include <cmath>

#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_OUTLINE_H

#include <dspace/Error.h>

namespace dspace {
namespace {

constexpr int CurvePieces = 4; // straight pieces that a curve of an outline becomes
constexpr double Steps = 64.0; // of contours in a unit of the font's own

Eigen::Vector2d Point(const FT_Vector* v) {
  return {double(v->x), double(v->y)};
}

struct Pen {
  std::vector<Contour> contours;
  Eigen::Vector2d at;

  void To(const Eigen::Vector2d& p) {
    this->at = p;
    this->contours.back().emplace_back(std::lround(p.x() * Steps), std::lround(p.y() * Steps));
  }
  static int Move(const FT_Vector* to, void* self) {
    Pen& pen = *static_cast<Pen*>(self);
    pen.contours.emplace_back();
    pen.To(Point(to));
    return 0;
  }
  static int Line(const FT_Vector* to, void* self) {
    static_cast<Pen*>(self)->To(Point(to));
    return 0;
  }
  static int Conic(const FT_Vector* control, const FT_Vector* to, void* self) {
    Pen& pen = *static_cast<Pen*>(self);
    const Eigen::Vector2d from = pen.at;
    for (int i = 1; i <= CurvePieces; ++i) {
      const double t = double(i) / CurvePieces;
      pen.To(from * ((1 - t) * (1 - t)) + Point(control) * (2 * t * (1 - t)) + Point(to) * (t * t));
    }
    return 0;
  }
  static int Cubic(const FT_Vector* c1, const FT_Vector* c2, const FT_Vector* to, void* self) {
    Pen& pen = *static_cast<Pen*>(self);
    const Eigen::Vector2d from = pen.at;
    for (int i = 1; i <= CurvePieces; ++i) {
      const double t = double(i) / CurvePieces;
      const double s = 1 - t;
      pen.To(from * (s * s * s) + Point(c1) * (3 * s * s * t) + Point(c2) * (3 * s * t * t) +
             Point(to) * (t * t * t));
    }
    return 0;
  }
};

} // namespace

struct OutlineFont::Face {
  FT_Library freetype = nullptr;
  FT_Face face = nullptr;
  double capital = 1.0; // in the font's own units

  Face() = default;
  Face(const Face&) = delete;
  Face& operator=(const Face&) = delete;
  ~Face() {
    FT_Done_Face(this->face);
    FT_Done_FreeType(this->freetype);
  }
};

OutlineFont::OutlineFont(Font font) : Face_(std::make_unique<Face>()) {
  Face& self = *this->Face_;
  if (FT_Init_FreeType(&self.freetype) != 0 ||
      FT_New_Face(self.freetype, FontFile(font), 0, &self.face) != 0 ||
      FT_Load_Char(self.face, 'H', FT_LOAD_NO_SCALE) != 0 ||
      self.face->glyph->metrics.height <= 0) {
    RejectFont(font);
  }
  self.capital = double(self.face->glyph->metrics.height);
}

OutlineFont::~OutlineFont() = default;

double OutlineFont::LineHeight() const {
  return double(this->Face_->face->height) / this->Face_->capital;
}

double OutlineFont::EmSize() const {
  return double(this->Face_->face->units_per_EM) / this->Face_->capital;
}

OutlineFont::Letter OutlineFont::Read(char32_t character) {
  FT_Face face = this->Face_->face;
  Letter letter;
  if (FT_Load_Char(face, character, FT_LOAD_NO_SCALE) != 0) {
    return letter;
  }
  Pen pen;
  const FT_Outline_Funcs steps = {Pen::Move, Pen::Line, Pen::Conic, Pen::Cubic, 0, 0};
  FT_Outline_Decompose(&face->glyph->outline, &steps, &pen);
  letter.area = FillContours(pen.contours);
  for (Eigen::Vector2d& p : letter.area.points) {
    p /= Steps * this->Face_->capital;
  }
  letter.advance = double(face->glyph->metrics.horiAdvance) / this->Face_->capital;
  return letter;
}

} // namespace dspace
