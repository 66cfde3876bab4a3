// Meta-kernels: text kernels that name the kernels to load.
#ifndef DSPACE_KERNELS_META_KERNEL_H
#define DSPACE_KERNELS_META_KERNEL_H

#include <string>
#include <vector>

#include <dspace/kernels/TextKernel.h>

namespace dspace {

// Whether the kernel assigns KERNELS_TO_LOAD.
bool IsMetaKernel(const TextKernel& kernel);

// The paths in KERNELS_TO_LOAD, in their order, with "$NAME" of PATH_SYMBOLS replaced by its value
// of PATH_VALUES; a text that ends in '+' is continued by the next one (NAIF, "Kernel Required
// Reading"). A relative path is one from the folder of the meta-kernel where there is such a file,
// else from the working folder. Throws Error(Corrupt), naming the file and line, for symbols
// without a value and for unknown symbols.
std::vector<std::string> KernelsToLoad(const TextKernel& kernel);

} // namespace dspace

#endif
