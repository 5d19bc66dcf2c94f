"""The engines behind one door: files in, a process, a Dataset out."""
