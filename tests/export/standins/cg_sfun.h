/* A stand-in of what ends an S-function outside of MATLAB: nothing. */
