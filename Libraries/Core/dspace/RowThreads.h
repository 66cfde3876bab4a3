// Rows of a grid, or items of a list, worked on by all cores.
#ifndef DSPACE_ROW_THREADS_H
#define DSPACE_ROW_THREADS_H

#include <functional>

namespace dspace {

// Calls work(first, last) for parts of the rows 0 .. rows - 1, first to last - 1, each row in one
// part, in several threads at once. Grids of few posts, and systems without more threads, have all
// rows in this thread. `columns` is the work of a row, in posts of a grid of heights (about 10 ns).
// After the last part throws the first exception of a part.
void ForRows(int rows, int columns, const std::function<void(int first, int last)>& work);

} // namespace dspace

#endif
