// Nothing: the precompiled headers are what this file is compiled for.
