// Draws vertices that a vertex shader places by their numbers alone.
#ifndef DSPACE_RENDER_EMPTY_VERTEX_ARRAY_H
#define DSPACE_RENDER_EMPTY_VERTEX_ARRAY_H

class vtkDspaceHubWindow;

namespace dspace {

// OpenGL's core profile needs a vertex array even where no attribute is read: made at the first
// use, in the context of the window, which must be current for Draw().
class EmptyVertexArray {
public:
  explicit EmptyVertexArray(vtkDspaceHubWindow* window) : Window_(window) {}
  EmptyVertexArray(const EmptyVertexArray&) = delete;
  EmptyVertexArray& operator=(const EmptyVertexArray&) = delete;
  ~EmptyVertexArray();

  // `primitive`: of glDrawArrays, with `count` vertices from 0.
  void Draw(unsigned int primitive, int count);
  // The triangle that covers the viewport, with the vertex shader of SurfaceShaders::Screen().
  void DrawScreen();
  void Release();

private:
  vtkDspaceHubWindow* Window_;
  unsigned int Array_ = 0;
};

} // namespace dspace

#endif
