"""The same static problem solved by this project and by other finite element codes, each in a process of its own."""
