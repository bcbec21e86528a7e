"""Tools: profiles asked by slope, their documents and files, the shipped library."""
